// Precast concrete of parking structures and bridges: double tees, wheel stops, girders, decks.
#include "assets/generator/pieces.h"
#include "assets/generator/shapes.h"

namespace rubble::generator {
namespace {

Recipe precast(const char* name, double cell, std::array<int, 3> triangles, double weight,
               std::vector<std::string> tags) {
  RandomStream random = piece_stream(name);
  Recipe r = concrete_recipe(name, random);
  r.solid.wear.edge_chip = 0.035, r.solid.wear.chip_size = 0.11;
  r.cell = cell;
  r.triangles = triangles;
  r.max_edge = 0.2;
  r.weight = weight;
  r.tags = std::move(tags);
  return r;
}

// The same break across every cell of a piece, so that they part together.
void break_all(Recipe& r, const Vec3& normal, const Vec3& through) {
  const Vec3 n = normalized(normal);
  for (Cell& cell : r.solid.cells) cell.push_back({n, dot(n, through), kBroken});
}

// The cell through which a line along X leaves the piece.
void strand(Recipe& r, std::size_t cell, const Vec3& through, double direction, double radius,
            RandomStream& random) {
  r.bars.push_back(protruding_bar(r.solid.cells[cell], through, {direction, 0, 0}, radius, random));
}

// A flange with tapering stems below; y: middles of the stems.
Recipe tee(const char* name, double length, double width, const std::vector<double>& stems,
           double weight, bool both_ends) {
  RandomStream random = piece_stream(std::string(name) + "/breaks");
  Recipe r = precast(name, 0.02, {5600, 1400, 160}, weight, {"concrete", "precast", "tee", "large"});
  const double half = length / 2, top = 0.3, flange = 0.1, low = -0.3;
  r.solid.cells.push_back(box_cell({-half, -width / 2, top - flange}, {half, width / 2, top}, kCast));
  for (const double y : stems) {
    r.solid.cells.push_back(extruded_cell(0,
                                          {{y - 0.06, low}, {y + 0.06, low}, {y + 0.10, top - 0.02},
                                           {y - 0.10, top - 0.02}},
                                          -half, half, kCast));
  }
  break_all(r, {1, 0.15, 0.25}, {half - 0.22, 0, 0});
  break_all(r, {1, -0.4, -0.1}, {half - 0.10, width / 4, 0});
  if (both_ends) break_all(r, {-1, 0.25, 0.2}, {-half + 0.25, 0, 0});
  for (std::size_t i = 0; i < stems.size(); ++i) {
    for (const double z : {low + 0.06, low + 0.14, low + 0.22}) {
      strand(r, i + 1, {0, stems[i], z}, 1, 0.007, random);
      if (both_ends) strand(r, i + 1, {0, stems[i], z}, -1, 0.007, random);
    }
  }
  return r;
}

// 1.8 m of car stop, with the holes of its two anchors.
Recipe wheel_stop(const char* name, bool broken) {
  RandomStream random = piece_stream(std::string(name) + "/breaks");
  Recipe r = precast(name, 0.009, {2600, 700, 220}, 0.8, {"concrete", "precast", "wheel_stop"});
  const double half = 0.9;
  r.solid.wear.edge_round = 0.012, r.solid.wear.edge_chip = 0.022;
  r.solid.cells = {extruded_cell(
      0, {{-0.075, -0.06}, {0.075, -0.06}, {0.07, -0.01}, {0.045, 0.06}, {-0.045, 0.06}, {-0.07, -0.01}},
      -half, half, kCast)};
  r.regions = {r.solid.cells[0]};
  for (const double x : {-0.6, 0.6}) {
    r.solid.hollows.push_back(cylinder_cell(2, {x, 0, 0}, 0.016, -0.2, 0.2, kCast));
  }
  if (broken) {
    break_all(r, {1, 0.3, 0.2}, {0.12, 0, 0});
    break_all(r, {1, -0.8, -0.3}, {0.17, 0, 0});
    r.regions = {r.solid.cells[0]};
    for (const double y : {-0.035, 0.035}) strand(r, 0, {-0.2, y, -0.02}, 1, 0.006, random);
  }
  return r;
}

// A bridge deck: asphalt worn off, two mats of bars in the broken edges. curb: one edge carries one.
Recipe deck(const char* name, const Vec3& half, bool curb, double weight) {
  RandomStream random = piece_stream(std::string(name) + "/breaks");
  Recipe r = precast(name, half.x > 1 ? 0.02 : 0.015, {5200, 1300, 130}, weight,
                     {"concrete", "deck", "large"});
  r.solid.cells = {box_cell(-half, half, kCast)};
  if (curb) {
    r.solid.cells.push_back(extruded_cell(0,
                                          {{half.y - 0.32, half.z - 0.05}, {half.y, half.z - 0.05},
                                           {half.y, half.z + 0.24}, {half.y - 0.26, half.z + 0.24}},
                                          -half.x, half.x, kCast));
  }
  break_all(r, {1, 0.2, 0.35}, {half.x * 0.88, 0, 0});
  break_all(r, {1, -0.7, -0.2}, {half.x * 0.92, half.y * 0.3, 0});
  break_all(r, {-1, 0.15, -0.3}, {-half.x * 0.9, 0, 0});
  if (!curb) break_all(r, {0.3, 1, 0.2}, {0, half.y * 0.86, 0});
  break_all(r, {-0.25, -1, 0.25}, {0, -half.y * 0.88, 0});
  for (double y = -0.7 * half.y; y < 0.7 * half.y; y += 0.2 * random.uniform(0.8, 1.2)) {
    for (const double z : {-half.z + 0.05, half.z - 0.05}) {
      if (random.uniform() < 0.75) strand(r, 0, {0, y, z}, 1, 0.008, random);
      if (random.uniform() < 0.5) strand(r, 0, {0, y, z}, -1, 0.008, random);
    }
  }
  return r;
}

// An I-shaped girder, prestressed, along X. split: the top flange broke off over half its length.
Recipe girder(const char* name, double length, bool split) {
  RandomStream random = piece_stream(std::string(name) + "/breaks");
  Recipe r = precast(name, 0.018, {5600, 1400, 240}, 0.12, {"concrete", "girder", "large"});
  const double half = length / 2;
  // Bottom bulb, web, top flange: outlines in y and z.
  r.solid.cells = {
      extruded_cell(0, {{-0.23, -0.45}, {0.23, -0.45}, {0.23, -0.31}, {0.08, -0.18}, {-0.08, -0.18},
                        {-0.23, -0.31}}, -half, half, kCast),
      extruded_cell(0, {{-0.08, -0.22}, {0.08, -0.22}, {0.08, 0.3}, {-0.08, 0.3}}, -half, half, kCast),
      extruded_cell(0, {{-0.15, 0.45}, {0.15, 0.45}, {0.15, 0.35}, {0.08, 0.27}, {-0.08, 0.27},
                        {-0.15, 0.35}}, -half, half, kCast)};
  break_all(r, {1, 0.15, 0.4}, {half - 0.3, 0, 0});
  break_all(r, {-1, 0.1, 0.3}, {-half + 0.3, 0, 0});
  if (split) {
    const Vec3 n = normalized(Vec3{1, 0.1, 0.5});
    for (std::size_t i = 1; i < 3; ++i) r.solid.cells[i].push_back({n, dot(n, {0.1, 0, 0.3}), kBroken});
  }
  for (const double y : {-0.16, -0.08, 0.0, 0.08, 0.16}) {
    strand(r, 0, {0, y, -0.40}, 1, 0.0075, random);
    strand(r, 0, {0, y, -0.40}, -1, 0.0075, random);
  }
  for (const double y : {-0.1, 0.1}) strand(r, 2, {-0.5, y, 0.41}, 1, 0.008, random);
  if (!split) return r;
  // Stirrups stand out of the web where the flange is gone.
  for (double x = 0.35; x < half - 0.5; x += 0.22) {
    r.bars.push_back(protruding_bar(r.solid.cells[1], {x, 0.03, 0}, {0, 0, 1}, 0.006, random));
  }
  return r;
}

// 1.5 m of concrete safety barrier.
Recipe barrier(const char* name, bool broken) {
  RandomStream random = piece_stream(std::string(name) + "/breaks");
  Recipe r = precast(name, 0.014, {3600, 900, 120}, 0.25, {"concrete", "barrier"});
  const double half = 0.75;
  r.solid.cells = {
      extruded_cell(0, {{-0.3, -0.4}, {0.3, -0.4}, {0.3, -0.325}, {0.17, -0.14}, {-0.17, -0.14},
                        {-0.3, -0.325}}, -half, half, kCast),
      extruded_cell(0, {{-0.178, -0.15}, {0.178, -0.15}, {0.10, 0.4}, {-0.10, 0.4}}, -half, half,
                    kCast)};
  if (broken) {
    break_all(r, {1, 0.2, 0.5}, {0.15, 0, 0});
    break_all(r, {1, -0.6, -0.2}, {0.32, 0, 0});
    for (const double y : {-0.06, 0.06}) strand(r, 1, {-0.3, y, 0.2}, 1, 0.008, random);
    for (const double y : {-0.18, 0.0, 0.18}) strand(r, 0, {-0.3, y, -0.3}, 1, 0.008, random);
  }
  return r;
}

// Fragments of a box culvert: a corner, with its haunch and the bars of both walls.
Recipe culvert_corner() {
  RandomStream random = piece_stream("culvert_corner/breaks");
  Recipe r = precast("culvert_corner", 0.015, {4200, 1000, 140}, 0.3, {"concrete", "culvert"});
  const double half = 0.6, thick = 0.15;
  r.solid.cells = {
      box_cell({-half, -0.45, -0.45}, {half, 0.55, -0.45 + thick}, kCast),
      box_cell({-half, -0.45, -0.45}, {half, -0.45 + thick, 0.5}, kCast),
      extruded_cell(0, {{-0.31, -0.31}, {-0.19, -0.31}, {-0.31, -0.19}}, -half, half, kCast)};
  r.solid.cells[0].push_back({normalized(Vec3{0.3, 1, 0.2}), 0.38, kBroken});
  r.solid.cells[1].push_back({normalized(Vec3{-0.35, 0.1, 1}), 0.34, kBroken});
  break_all(r, {1, 0.2, 0.3}, {half - 0.2, 0, 0});
  for (const double x : {-0.35, -0.1, 0.15}) {
    r.bars.push_back(protruding_bar(r.solid.cells[0], {x, 0, -0.4}, {0, 1, 0}, 0.006, random));
    r.bars.push_back(protruding_bar(r.solid.cells[1], {x, -0.4, 0}, {0, 0, 1}, 0.006, random));
  }
  return r;
}

// A hollow-core floor plank: five bores along X, one end broken through them.
Recipe hollow_core() {
  Recipe r = precast("hollow_core", 0.012, {5600, 1400, 480}, 0.25, {"concrete", "slab", "void"});
  const double half = 0.9, half_y = 0.6, half_z = 0.1, bore = 0.07, pitch = 0.22;
  Cell plank = box_cell({-half, -half_y, -half_z}, {half, half_y, half_z}, kCast);
  plank.push_back({normalized(Vec3{1, 0.35, 0.15}), 0.72, kBroken});
  plank.push_back({normalized(Vec3{1, -0.5, -0.1}), 0.78, kBroken});
  r.solid.cells = {plank};
  for (int i = -2; i <= 2; ++i) {
    r.solid.hollows.push_back(cylinder_cell(0, {0, pitch * i, 0}, bore, -2, 2, kCast));
  }
  // Webs from bottom to top between the bores, slabs above and below them.
  const auto cut = [&](const Vec3& low, const Vec3& high) {
    Cell cell = plank;
    const Cell box = box_cell(low, high, kCast);
    cell.insert(cell.end(), box.begin(), box.end());
    r.regions.push_back(cell);
  };
  cut({-2, -1, 0.055}, {2, 1, 1});
  cut({-2, -1, -1}, {2, 1, -0.055});
  for (int i = -3; i < 3; ++i) {
    const double low = i == -3 ? -1 : pitch * i + 0.055, high = i == 2 ? 1 : pitch * (i + 1) - 0.055;
    cut({-2, low, -0.06}, {2, high, 0.06});
  }
  return r;
}

// A lump with bars in it.
Recipe barred_chunk(const char* name, const Vec3& half, int bars) {
  RandomStream random = piece_stream(std::string(name) + "/breaks");
  Recipe r = precast(name, 0.011, {2800, 600, 60}, 0.8, {"concrete", "chunk"});
  Cell cell = box_cell(-half, half, kBroken);
  cell[4].surface = kCast;
  for (int i = 0; i < 8; ++i) {
    const Vec3 n = random.direction();
    const Vec3 scaled{n.x * half.x, n.y * half.y, n.z * half.z};
    const double share = random.uniform(0.86, 1.05);
    cell.push_back({n, norm(scaled) * share, kBroken});
  }
  r.solid.cells = {cell};
  r.solid.wear.fracture_size = 0.085, r.solid.wear.fracture_depth = 0.0075;
  r.solid.wear.edge_chip = 0.024, r.solid.wear.chip_size = 0.06;
  r.max_edge = 0.07;
  for (int i = 0; i < bars; ++i) {
    const double y = half.y * (-0.5 + double(i) / std::max(1, bars - 1));
    strand(r, 0, {0, y, 0.2 * half.z}, 1, 0.006, random);
    strand(r, 0, {0, y, 0.2 * half.z}, -1, 0.006, random);
  }
  r.scale_min = 0.7, r.scale_max = 1.3;
  return r;
}

}  // namespace

std::vector<Recipe> parking_concrete() {
  return {tee("double_tee", 3.2, 2.4, {-0.6, 0.6}, 0.06, false),
          tee("double_tee_broken", 1.8, 2.2, {-0.6, 0.6}, 0.1, true),
          tee("single_tee", 2.0, 1.0, {0.1}, 0.15, true), wheel_stop("wheel_stop", false),
          wheel_stop("wheel_stop_broken", true)};
}

std::vector<Recipe> bridge_concrete() {
  return {deck("deck_slab", {1.5, 1.1, 0.125}, false, 0.12),
          deck("deck_slab_small", {0.8, 0.65, 0.11}, false, 0.5),
          deck("deck_edge", {1.2, 0.7, 0.125}, true, 0.2), girder("girder", 2.8, false),
          girder("girder_broken", 2.4, true), barrier("barrier", false),
          barrier("barrier_broken", true)};
}

std::vector<Recipe> concrete_fragments() {
  return {culvert_corner(), hollow_core(), barred_chunk("chunk_bars_1", {0.26, 0.2, 0.13}, 2),
          barred_chunk("chunk_bars_2", {0.36, 0.26, 0.16}, 3)};
}

}  // namespace rubble::generator
