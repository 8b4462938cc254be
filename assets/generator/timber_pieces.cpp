#include "assets/generator/pieces.h"
#include "assets/generator/shapes.h"

namespace rubble::generator {
namespace {

constexpr Surface kSawn = Surface::timber;
constexpr Surface kTorn = Surface::timber_fracture;

struct Stick {
  const char* name;
  Vec3 half;           // unit: m
  bool broken_low, broken_high;
  double splinter;     // unit: m
  double cell;         // of the grid; unit: m
  double weight;
};

Recipe stick(const Stick& shape) {
  RandomStream random = piece_stream(shape.name);
  Recipe r = plain_recipe(shape.name, random, "timber", timber_wear(), shape.cell);
  Cell cell = box_cell(-shape.half, shape.half, kSawn);
  if (shape.broken_high) break_end(cell, 0, 1, 0.9, kTorn, random);
  if (shape.broken_low) break_end(cell, 0, -1, 0.9, kTorn, random);
  r.solid.cells = {cell};
  r.solid.wear.fracture_depth = shape.splinter;
  r.triangles = {2600, 600, 60};
  r.max_edge = 0.12;
  r.scale_min = 0.85, r.scale_max = 1.15;
  r.weight = shape.weight;
  r.tags = {"timber", shape.half.z > 0.06 ? "beam" : "stud"};
  return r;
}

// A stud split along its fibres: one long face is torn, and the ends run out to splinters.
Recipe split_stud() {
  RandomStream random = piece_stream("stud_split");
  Recipe r = plain_recipe("stud_split", random, "timber", timber_wear(), 0.0045);
  Cell cell = box_cell({-0.55, -0.022, -0.047}, {0.55, 0.022, 0.047}, kSawn);
  cell.push_back({normalized(Vec3{0.05, 0.1, 1}), 0.012, kTorn});
  break_end(cell, 0, 1, 1.2, kTorn, random);
  r.solid.cells = {cell};
  r.solid.wear.fracture_depth = 0.02;
  r.solid.wear.fracture_size = 0.02;
  r.triangles = {2600, 700, 200};
  r.max_edge = 0.12;
  r.tags = {"timber", "stud"};
  return r;
}

// A sheet of layers of veneer: its torn sides step down from layer to layer.
Recipe plywood(const char* name, double half_x, double half_y, bool two_sides, double weight) {
  RandomStream random = piece_stream(name);
  Recipe r = plain_recipe(name, random, "plywood", plywood_wear(), 0.005);
  r.solid.wear.fracture_depth = 0.06;
  const double half_z = 0.009;
  for (int layer = 0; layer < 3; ++layer) {
    const double low = -half_z + 0.006 * layer;
    Cell cell = box_cell({-half_x, -half_y, low - (layer ? 1e-3 : 0)},
                         {half_x, half_y, low + 0.006 + (layer < 2 ? 1e-3 : 0)}, kSawn);
    const double step = 0.02 * random.uniform(-1, 1);
    cell.push_back({normalized(Vec3{1, 0.25, 0}), 0.86 * half_x + step, kTorn});
    cell.push_back({normalized(Vec3{1, -0.35, 0}), 0.9 * half_x + step, kTorn});
    if (two_sides) cell.push_back({normalized(Vec3{-0.4, 1, 0}), 0.8 * half_y + step, kTorn});
    r.solid.cells.push_back(cell);
  }
  r.regions = {r.solid.cells[0]};
  r.regions[0][4].offset = half_z + 1e-3, r.regions[0][5].offset = half_z + 1e-3;
  for (Face& f : r.regions[0]) f.offset += 0.021;
  r.triangles = {4600, 1100, 360};
  r.max_edge = 0.2;
  r.weight = weight;
  r.tags = {"timber", "sheet"};
  return r;
}

}  // namespace

std::vector<Recipe> timber_pieces() {
  return {stick({"timber_beam", {1.3, 0.07, 0.12}, false, true, 0.11, 0.007, 0.25}),
          stick({"timber_beam_broken", {0.65, 0.07, 0.12}, true, true, 0.13, 0.007, 0.4}),
          stick({"stud", {1.2, 0.0225, 0.0475}, false, false, 0.05, 0.006, 0.8}),
          stick({"stud_broken", {0.6, 0.0225, 0.0475}, false, true, 0.09, 0.0045, 1.2}),
          split_stud(),
          plywood("plywood_sheet", 0.61, 0.61, false, 0.4),
          plywood("plywood_broken", 0.36, 0.26, true, 0.8)};
}

}  // namespace rubble::generator
