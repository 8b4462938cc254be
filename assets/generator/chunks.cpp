#include "assets/generator/pieces.h"
#include "kernel/base/random.h"

namespace rubble::generator {
namespace {

// A lump between random planes about a middle point, as a Voronoi cell is; the first `cast` faces
// were a formed surface before it broke.
Recipe chunk(const std::string& name, const Vec3& half_size, int faces, int cast) {
  RandomStream random(2024, "concrete/" + name);
  Recipe r;
  r.name = name;
  Cell cell;
  for (int i = 0; i < 60 && static_cast<int>(cell.size()) < faces; ++i) {
    Vec3 n = random.direction();
    if (i < cast) n = i == 0 ? Vec3{0, 0, 1} : Vec3{0, 0, -1};
    bool apart = true;
    for (const Face& f : cell) apart = apart && dot(f.normal, n) < 0.75;
    if (!apart) continue;
    const Vec3 scaled{n.x * half_size.x, n.y * half_size.y, n.z * half_size.z};
    const bool is_cast = i < cast;
    cell.push_back({n, norm(scaled) * (is_cast ? 1 : random.uniform(0.75, 1.0)),
                    is_cast ? Surface::concrete_cast : Surface::concrete_fracture});
  }
  r.solid.cells = {cell};
  r.solid.seed = static_cast<std::uint32_t>(random.next());
  r.cell = 0.011;
  r.triangles = {1800, 400, 50};
  r.scale_min = 0.5, r.scale_max = 1.3;
  r.tags = {"concrete", "chunk"};
  return r;
}

}  // namespace

std::vector<Recipe> chunk_pieces() {
  return {chunk("chunk_1", {0.22, 0.18, 0.15}, 12, 0), chunk("chunk_2", {0.25, 0.2, 0.1}, 11, 2)};
}

}  // namespace rubble::generator
