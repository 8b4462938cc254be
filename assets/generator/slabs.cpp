#include "assets/generator/pieces.h"
#include "kernel/base/portable_math.h"
#include "kernel/base/random.h"

namespace rubble::generator {
namespace {

struct SlabSize {
  double length, width, thickness;  // unit: m
  int sides;
  int bars;
};

// Cast top and bottom; a rim of broken, leaning faces around a rectangle.
Recipe slab(const std::string& name, const SlabSize& size) {
  RandomStream random(2024, "concrete/" + name);
  Recipe r;
  r.name = name;
  Cell cell{{{0, 0, 1}, size.thickness / 2, Surface::concrete_cast},
            {{0, 0, -1}, size.thickness / 2, Surface::concrete_cast}};
  for (int i = 0; i < size.sides; ++i) {
    const double angle = 2 * portable::kPi * (i + random.uniform(-0.25, 0.25)) / size.sides;
    const portable::SinCos turn = portable::sincos(angle);
    const Vec3 n = normalized(Vec3{turn.cos, turn.sin, random.uniform(-0.35, 0.35)});
    const Vec3 scaled{n.x * size.length / 2, n.y * size.width / 2, 0};
    cell.push_back({n, norm(scaled) * random.uniform(0.86, 1.0), Surface::concrete_fracture});
  }
  r.solid.cells = {cell};
  r.solid.seed = static_cast<std::uint32_t>(random.next());
  r.cell = 0.012;
  r.triangles = {3000, 700, 60};
  r.scale_min = 0.7, r.scale_max = 1.3;
  r.tags = {"concrete", "slab"};
  return r;
}

}  // namespace

std::vector<Recipe> slab_pieces() { return {slab("slab_1", {1.2, 0.9, 0.14, 9, 0})}; }

}  // namespace rubble::generator
