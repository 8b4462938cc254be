#include "assets/generator/pieces.h"
#include "assets/generator/shapes.h"

namespace rubble::generator {
namespace {

// Planes about a point at random distances, like the cell of a Voronoi diagram. The first `cast`
// faces are top and bottom of the slab or wall it broke from.
Cell broken_cell(RandomStream& random, const Vec3& centre, const Vec3& half_size, int faces,
                 int cast) {
  Cell cell;
  for (int i = 0; i < 200 && static_cast<int>(cell.size()) < faces; ++i) {
    const bool is_cast = i < cast;
    const Vec3 n = is_cast ? Vec3{0, 0, i == 0 ? 1.0 : -1.0} : random.direction();
    bool apart = true;
    for (const Face& f : cell) apart = apart && dot(f.normal, n) < 0.72;
    if (!apart) continue;
    const Vec3 scaled{n.x * half_size.x, n.y * half_size.y, n.z * half_size.z};
    const double reach = norm(scaled) * (is_cast ? 1 : random.uniform(0.72, 1.0));
    cell.push_back(
        {n, dot(n, centre) + reach, is_cast ? Surface::concrete_cast : Surface::concrete_fracture});
  }
  return cell;
}

struct ChunkShape {
  const char* name;
  Vec3 half_size;  // unit: m
  int faces;
  int cast;   // formed faces: 0 to 2
  int lobes;  // 1: convex; 2: with a notch between two cells
};

Recipe chunk(const ChunkShape& shape) {
  RandomStream random = piece_stream(shape.name);
  Recipe r = concrete_recipe(shape.name, random);
  const Vec3& h = shape.half_size;
  r.solid.cells.push_back(broken_cell(random, {}, h, shape.faces, shape.cast));
  if (shape.lobes == 2) {
    const double side = random.uniform(-0.5, 0.5);
    const Vec3 centre{0.75 * h.x, side * h.y, 0};
    const Vec3 half{0.6 * h.x, 0.7 * h.y, shape.cast == 2 ? h.z : 0.8 * h.z};
    r.solid.cells.push_back(broken_cell(random, centre, half, shape.faces - 1, shape.cast));
  }
  const bool small = norm(h) < 0.22;
  r.solid.wear.fracture_size = small ? 0.06 : 0.085;
  r.solid.wear.fracture_depth = small ? 0.005 : 0.0075;
  if (small) r.solid.wear.edge_round = 0.010, r.solid.wear.edge_chip = 0.016;
  r.cell = small ? 0.008 : 0.011;
  r.triangles = {small ? 1700 : 2600, 450, 50 * shape.lobes};
  r.max_edge = 0.07;
  r.scale_min = 0.6, r.scale_max = 1.3;
  r.weight = 1.5;
  r.tags = {"concrete", "chunk"};
  return r;
}

}  // namespace

std::vector<Recipe> chunk_pieces() {
  static const ChunkShape kShapes[] = {
      {"chunk_1", {0.24, 0.19, 0.16}, 12, 0, 1}, {"chunk_2", {0.26, 0.22, 0.09}, 11, 2, 1},
      {"chunk_3", {0.22, 0.20, 0.13}, 11, 1, 2}, {"chunk_4", {0.14, 0.11, 0.09}, 12, 0, 1},
      {"chunk_5", {0.30, 0.16, 0.14}, 11, 0, 2}, {"chunk_6", {0.16, 0.13, 0.07}, 10, 2, 2}};
  std::vector<Recipe> pieces;
  for (const ChunkShape& shape : kShapes) pieces.push_back(chunk(shape));
  return pieces;
}

}  // namespace rubble::generator
