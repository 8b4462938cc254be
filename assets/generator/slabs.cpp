#include "assets/generator/pieces.h"
#include "assets/generator/shapes.h"
#include "kernel/base/portable_math.h"

namespace rubble::generator {
namespace {

struct Lobe {  // a broken outline about a point, half sizes; unit: m
  double x, y, half_x, half_y;
  int sides;
};

constexpr double kRidged = 0.4;  // share of the rim's sides that broke along two planes

void add_break(Cell& cell, const Vec3& normal, const Vec3& through) {
  const Vec3 n = normalized(normal);
  cell.push_back({n, dot(n, through), Surface::concrete_fracture});
}

// Cast top and bottom; a rim of broken, leaning faces.
Cell slab_cell(RandomStream& random, const Lobe& lobe, double thickness) {
  Cell cell{{{0, 0, 1}, thickness / 2, Surface::concrete_cast},
            {{0, 0, -1}, thickness / 2, Surface::concrete_cast}};
  for (int i = 0; i < lobe.sides; ++i) {
    const double angle = 2 * portable::kPi * (i + random.uniform(-0.3, 0.3)) / lobe.sides;
    const portable::SinCos turn = portable::sincos(angle);
    const double lean = random.uniform(-0.5, 0.5);
    const double reach = norm(Vec3{turn.cos * lobe.half_x, turn.sin * lobe.half_y, 0});
    // One draw a statement: C++ fixes no order within an expression.
    const double out = reach * random.uniform(0.84, 1.0);
    const double up = thickness * random.uniform(-0.2, 0.2);
    const Vec3 middle = Vec3{lobe.x, lobe.y, up} + Vec3{turn.cos, turn.sin, 0} * out;
    add_break(cell, {turn.cos, turn.sin, lean}, middle);
    if (random.uniform() < kRidged) {  // the break changed its lean at half depth
      add_break(cell, {turn.cos, turn.sin, lean > 0 ? lean - 0.8 : lean + 0.8}, middle);
    }
  }
  return cell;
}

// Bars of the lower mat, along X or Y, that stick out of the rim on one side.
void add_bars(Recipe& r, RandomStream& random, const Lobe& lobe, double thickness, Vec3 direction,
              double spacing) {
  const Vec3 across{-direction.y, direction.x, 0};
  const double half = direction.x != 0 ? lobe.half_y : lobe.half_x;
  for (double s = -0.7 * half; s < 0.7 * half; s += spacing * random.uniform(0.85, 1.15)) {
    const Vec3 through = Vec3{lobe.x, lobe.y, -thickness / 2 + 0.04} + across * s;
    r.bars.push_back(protruding_bar(r.solid.cells[0], through, direction, 0.006, random));
  }
}

struct SlabShape {
  const char* name;
  double thickness;  // unit: m
  std::vector<Lobe> lobes;
  std::vector<Vec3> bar_sides;  // unit vectors
  double bar_spacing = 0.18;    // unit: m
};

Recipe slab(const SlabShape& shape) {
  RandomStream random = piece_stream(shape.name);
  Recipe r = concrete_recipe(shape.name, random);
  for (const Lobe& lobe : shape.lobes) {
    r.solid.cells.push_back(slab_cell(random, lobe, shape.thickness));
  }
  for (const Vec3& side : shape.bar_sides) {
    add_bars(r, random, shape.lobes[0], shape.thickness, side, shape.bar_spacing);
  }
  r.solid.wear.fracture_depth = 0.009;
  const bool small = shape.lobes[0].half_x < 0.4;
  if (small) r.solid.wear.edge_round = 0.010, r.solid.wear.edge_chip = 0.016;
  r.cell = small ? 0.009 : 0.012;
  r.triangles = {3800, 900, 80};
  r.scale_min = 0.7, r.scale_max = 1.3;
  r.tags = {"concrete", "slab"};
  return r;
}

}  // namespace

std::vector<Recipe> slab_pieces() {
  const std::vector<SlabShape> shapes = {
      {"slab_1", 0.14, {{0, 0, 0.60, 0.45, 9}}, {{1, 0, 0}}},
      {"slab_2", 0.12, {{-0.1, 0, 0.45, 0.38, 8}, {0.3, 0.12, 0.32, 0.26, 7}}, {{-1, 0, 0}}},
      {"slab_3", 0.16, {{0, 0, 0.42, 0.33, 8}}, {}},
      {"slab_4", 0.18, {{0, -0.1, 0.75, 0.40, 10}, {-0.3, 0.22, 0.36, 0.36, 8}}, {{1, 0, 0}}, 0.22},
      {"slab_5", 0.08, {{0, 0, 0.34, 0.27, 8}, {0.16, -0.1, 0.2, 0.2, 7}}, {}}};
  std::vector<Recipe> pieces;
  for (const SlabShape& shape : shapes) pieces.push_back(slab(shape));
  return pieces;
}

}  // namespace rubble::generator
