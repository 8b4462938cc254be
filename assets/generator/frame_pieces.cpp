#include "assets/generator/pieces.h"
#include "assets/generator/shapes.h"

namespace rubble::generator {
namespace {

// Long cast edges are knocked off here and there, more coarsely than those of small pieces.
constexpr double kEdgeChip = 0.037, kChipSize = 0.11;  // unit: m

// A cast prism along X whose ends broke off, with a longitudinal bar near each edge of the section.
Recipe member(const char* name, const Vec3& half, double bar_radius) {
  RandomStream random = piece_stream(name);
  Recipe r = concrete_recipe(name, random);
  Cell cell = box_cell(-half, half, kCast);
  for (int end = 0; end < 2; ++end) {
    const Vec3 lean{0, random.uniform(-0.35, 0.35), random.uniform(-0.35, 0.35)};
    cell[end] = {normalized(Vec3{end == 0 ? 1.0 : -1.0, 0, 0} + lean), half.x * 0.94, kBroken};
    // A second break across one edge of the end.
    const double side = random.uniform() < 0.5 ? 1 : -1;
    const Vec3 n = normalized(Vec3{end == 0 ? 1.0 : -1.0, 0.9 * side, random.uniform(-0.6, 0.6)});
    cell.push_back({n, norm(Vec3{n.x * half.x, n.y * half.y, n.z * half.z}) * 0.9, kBroken});
  }
  r.solid.cells = {cell};
  for (const double x : {1.0, -1.0}) {
    for (const double y : {1.0, -1.0}) {
      for (const double z : {1.0, -1.0}) {
        const Vec3 through{0, y * (half.y - 0.045), z * (half.z - 0.045)};
        r.bars.push_back(protruding_bar(cell, through, {x, 0, 0}, bar_radius, random));
      }
    }
  }
  r.solid.wear.edge_chip = kEdgeChip, r.solid.wear.chip_size = kChipSize;
  r.cell = 0.012;
  r.triangles = {3000, 700, 70};
  r.max_edge = 0.12;
  r.scale_min = 0.8, r.scale_max = 1.2;
  r.weight = 0.3;
  return r;
}

Recipe column() {
  Recipe r = member("column", {0.65, 0.15, 0.15}, 0.008);
  r.tags = {"concrete", "column"};
  return r;
}

Recipe beam() {
  Recipe r = member("beam", {0.95, 0.125, 0.2}, 0.008);
  r.tags = {"concrete", "beam"};
  return r;
}

// 4 x 3 x 0.2 m: three edges were cast, the fourth broke and shows its bars.
Recipe floor_slab() {
  RandomStream random = piece_stream("floor_slab");
  Recipe r = concrete_recipe("floor_slab", random);
  Cell cell = box_cell({-2, -1.5, -0.1}, {2, 1.5, 0.1}, kCast);
  cell[0] = {normalized(Vec3{1, 0.03, 0.15}), 1.97, kBroken};
  cell.push_back({normalized(Vec3{1, 0.5, -0.1}), 2.3, kBroken});
  cell.push_back({normalized(Vec3{1, -0.9, 0.1}), 2.48, kBroken});
  r.solid.cells = {cell};
  for (double y = -1.3; y < 1.35; y += 0.29) {
    const double z = random.uniform() < 0.6 ? -0.06 : 0.06;
    r.bars.push_back(protruding_bar(cell, {0, y, z}, {1, 0, 0}, 0.006, random));
  }
  r.solid.wear.edge_chip = kEdgeChip, r.solid.wear.chip_size = kChipSize;
  r.cell = 0.02;
  r.triangles = {4600, 1100, 90};
  r.max_edge = 0.3;
  r.weight = 0.05;
  r.tags = {"concrete", "slab", "floor", "large"};
  return r;
}

// 3 x 0.25 x 1.4 m, standing; its top broke in steps and its bars stand out of it.
Recipe wall_stub() {
  RandomStream random = piece_stream("wall_stub");
  Recipe r = concrete_recipe("wall_stub", random);
  const double step = 0.5;
  for (int i = 0; i < 6; ++i) {
    const double left = -1.5 + step * i, lap = 0.05;
    Cell cell = box_cell({left - (i > 0 ? lap : 0), -0.125, -0.7},
                         {left + step + (i < 5 ? lap : 0), 0.125, 0.7}, kCast);
    const Vec3 lean = normalized(Vec3{random.uniform(-0.5, 0.5), random.uniform(-0.3, 0.3), 1});
    const Vec3 middle{left + step / 2, 0, random.uniform(0.3, 0.58)};
    // The steps of the top show the broken sides of the sections.
    if (i < 5) cell[0].surface = kBroken;
    if (i > 0) cell[1].surface = kBroken;
    cell[4] = {lean, dot(lean, middle), kBroken};
    r.solid.cells.push_back(cell);
    for (const double y : {-0.08, 0.08}) {
      const Vec3 through{middle.x + random.uniform(-0.08, 0.08), y, 0};
      r.bars.push_back(protruding_bar(cell, through, {0, 0, 1}, 0.006, random));
    }
  }
  r.solid.wear.edge_chip = kEdgeChip, r.solid.wear.chip_size = kChipSize;
  r.cell = 0.018;
  r.triangles = {4600, 1100, 120};
  r.max_edge = 0.2;
  r.weight = 0.05;
  r.tags = {"concrete", "wall", "large"};
  return r;
}

Recipe rebar(const char* name, std::vector<Vec3> line, double radius) {
  Recipe r;
  r.name = name;
  r.bars = {{std::move(line), radius, 0, true}};
  r.material = "steel";
  r.weight = 0.4;
  r.tags = {"steel", "rebar"};
  return r;
}

}  // namespace

std::vector<Recipe> frame_pieces() { return {column(), beam(), floor_slab(), wall_stub()}; }

std::vector<Recipe> rebar_pieces() {
  return {rebar("rebar_straight", {{-0.45, 0, 0}, {0.45, 0, 0}}, 0.008),
          rebar("rebar_bent",
                {{-0.5, -0.05, 0}, {-0.1, 0.04, 0.01}, {0.15, -0.02, 0.05}, {0.5, 0.1, 0}}, 0.006),
          rebar("rebar_hook", {{-0.4, 0, 0}, {0.25, 0.02, 0}, {0.33, 0.1, 0.01}, {0.27, 0.2, 0.02}},
                0.006)};
}

}  // namespace rubble::generator
