// Rolled steel: guard rails, girders, bridge rails; and clusters of reinforcing bars.
#include <cmath>

#include "assets/generator/noise.h"
#include "assets/generator/pieces.h"
#include "assets/generator/shapes.h"
#include "kernel/base/portable_math.h"

namespace rubble::generator {
namespace {

constexpr Surface kZinc = Surface::steel_galvanised;
constexpr Surface kRust = Surface::steel_rusty;

// The two-wave profile of a guard rail, 0.31 m high and 0.08 m deep: y of the sheet over z.
constexpr double kProfile[][2] = {{0.000, -0.155}, {0.018, -0.150}, {0.081, -0.105}, {0.081, -0.085},
                                  {0.081, -0.070}, {0.012, -0.022}, {0.002, 0.000},  {0.012, 0.022},
                                  {0.081, 0.070},  {0.081, 0.085},  {0.081, 0.105},  {0.018, 0.150},
                                  {0.000, 0.155}};
constexpr int kProfilePoints = 13;

// A length of W-beam along X. bend: how far its middle is pushed back; crush: how flat it is there.
Recipe guard_rail(const char* name, double length, double bend, double crush) {
  RandomStream random = piece_stream(name);
  Recipe r;
  r.name = name;
  Sheet sheet;
  sheet.columns = 41, sheet.rows = kProfilePoints, sheet.thickness = 0.004;
  sheet.front = kZinc, sheet.back = kZinc;
  const double kink = random.uniform(-0.1, 0.1) * length, twist = random.uniform(-0.12, 0.12);
  for (int row = 0; row < sheet.rows; ++row) {
    for (int c = 0; c < sheet.columns; ++c) {
      const double x = length * (double(c) / (sheet.columns - 1) - 0.5);
      const double q = (x - kink) / (0.22 * length), near = 1 / (1 + q * q);
      const double depth = kProfile[row][0] * (1 - crush * near * near);
      const double z = kProfile[row][1] * (1 + 0.25 * crush * near);
      const double roll = bend > 0 ? twist * x : 0;
      const double small = 0.004 * bend * 10 * gradient_noise({x * 4, kProfile[row][1] * 9, 0.5}, 91);
      sheet.points.push_back({x, depth - bend * near + 0.5 * bend + roll * z + small, z - roll * depth});
    }
  }
  // One part to each plank of the profile; more along X where it is bent.
  const int planks[][2] = {{0, 2}, {2, 4}, {4, 6}, {6, 8}, {8, 10}, {10, 12}};
  const int steps = bend > 0 ? 5 : 1;
  for (const auto& plank : planks) {
    for (int k = 0; k < steps; ++k) {
      r.parts.push_back(sheet_part(sheet, plank[0], plank[1], 40 * k / steps, 40 * (k + 1) / steps, 0.012));
    }
  }
  r.sheets = {sheet};
  r.triangles = {2200, 1100, 560};
  r.max_edge = 0.2;
  r.material = "steel";
  r.weight = 0.6;
  r.tags = {"steel", "guard_rail"};
  return r;
}

// A post with the block that the rail was bolted to, bent over at its foot.
Recipe guard_post() {
  RandomStream random = piece_stream("guard_rail_post");
  Recipe r = plain_recipe("guard_rail_post", random, "steel", steel_wear(), 0.006);
  r.solid.wear.edge_round = 0.003;
  const double t = 0.006, half = 0.06;
  auto& cells = r.solid.cells;
  cells = {box_cell({-t, -half, -0.55}, {t, half, 0.55}, kZinc),
           box_cell({-0.05, -half, -0.55}, {0.05, -half + 2 * t, 0.55}, kZinc),
           box_cell({-0.05, half - 2 * t, -0.55}, {0.05, half, 0.55}, kZinc)};
  Recipe block;
  block.solid.wear = timber_wear();
  block.solid.wear.along = {0, 0, 1};
  block.solid.cells = {box_cell({-0.07, half - 0.002, 0.2}, {0.07, half + 0.15, 0.53}, Surface::timber)};
  block.solid.seed = 5;
  block.cell = 0.009;
  block.triangles = {500, 140, 30};
  const Warp bend = [](const Vec3& p) {  // hit from the road side
    const double over = std::fmax(0.0, p.z + 0.25);
    return Vec3{p.x, p.y - 0.35 * over * over, p.z - 0.06 * over * over};
  };
  block.warp = bend;
  block.regions = {block.solid.cells[0]};
  r.warp = bend;
  for (const Cell& cell : cells) {
    for (const auto& z : {std::array<double, 2>{-0.57, -0.18}, {-0.18, 0.2}, {0.2, 0.57}}) {
      Cell region = cell;
      for (Face& f : region) f.offset += 0.004;
      region[4].offset = z[1], region[5].offset = -z[0];
      r.regions.push_back(region);
    }
  }
  r.attached = {block};
  r.triangles = {1800, 900, 400};
  r.max_edge = 0.12;
  r.weight = 0.4;
  r.tags = {"steel", "guard_rail"};
  return r;
}

// A rolled I-beam along X with stiffeners, its flanges buckled. torn: both ends ripped.
Recipe i_beam(const char* name, double length, double bend, bool torn) {
  RandomStream random = piece_stream(name);
  Recipe r = plain_recipe(name, random, "steel", steel_wear(), 0.010);
  r.solid.wear.edge_round = 0.004;
  const double half = length / 2, high = 0.18, wide = 0.1, web = 0.007, flange = 0.014;
  auto& cells = r.solid.cells;
  cells = {box_cell({-half, -web, -high}, {half, web, high}, kRust),
           box_cell({-half, -wide, -high}, {half, wide, -high + flange}, kRust),
           box_cell({-half, -wide, high - flange}, {half, wide, high}, kRust)};
  if (torn) {
    for (Cell& cell : cells) {
      const double lean = random.uniform(-0.5, 0.5), tip = random.uniform(-0.5, 0.5);
      cell.push_back({normalized(Vec3{1, lean, tip}), half - 0.15, kRust, false, true});
      cell.push_back({normalized(Vec3{-1, tip, lean}), half - 0.15, kRust, false, true});
    }
    r.solid.wear.fracture_depth = 0.03, r.solid.wear.fracture_size = 0.05;
  }
  const std::size_t long_ones = cells.size();
  for (double x = -half + 0.45; x < half - 0.3; x += 0.8) {
    for (const double side : {1.0, -1.0}) {
      cells.push_back(box_cell({x - 0.006, side > 0 ? 0.0 : -wide + 0.01, -high + 0.005},
                               {x + 0.006, side > 0 ? wide - 0.01 : 0.0, high - 0.005}, kRust));
    }
  }
  r.warp = [bend, half, wide](const Vec3& p) {
    const double s = p.x / half;
    const double buckle = 0.10 * bend * p.y / wide * portable::sin(7 * s) * (p.z > 0 ? 1 : 0.4);
    return Vec3{p.x, p.y + bend * (0.6 * s * s + 0.25 * s * s * s) - 0.2 * bend + 0.3 * bend * s * p.z,
                p.z - 0.5 * bend * s * s + 0.15 * bend + buckle};
  };
  const int steps = 5;
  for (std::size_t i = 0; i < long_ones; ++i) {
    for (int k = 0; k < steps; ++k) {
      Cell region = cells[i];
      for (Face& f : region) f.offset += 0.003;
      region.push_back({{1, 0, 0}, -half + length * (k + 1) / steps, kRust});
      region.push_back({{-1, 0, 0}, half - length * k / steps, kRust});
      r.regions.push_back(region);
    }
  }
  for (std::size_t i = long_ones; i < cells.size(); ++i) {
    r.regions.push_back(cells[i]);
    for (Face& f : r.regions.back()) f.offset += 0.002;
  }
  r.triangles = {5200, 1400, 400};
  r.max_edge = 0.15;
  r.weight = 0.2;
  r.tags = {"steel", "girder", "large"};
  return r;
}

Bar tube(std::vector<Vec3> line, double radius, bool collides = true) {
  return {std::move(line), radius, 0, collides, kZinc};
}

// Two rails on three posts, kinked where it was hit.
Recipe bridge_rail() {
  Recipe r;
  r.name = "bridge_rail";
  for (const double z : {0.0, 0.4}) {
    r.bars.push_back(tube({{-1.2, 0.02, z}, {-0.2, -0.01, z + 0.01}, {0.35, 0.16, z - 0.04},
                           {1.25, 0.10, z - 0.02}}, 0.030));
  }
  r.bars.push_back(tube({{-0.9, 0.012, -0.5}, {-0.9, 0.012, 0.44}}, 0.035));
  r.bars.push_back(tube({{0.1, -0.12, -0.48}, {0.1, 0.02, -0.1}, {0.1, 0.09, 0.43}}, 0.035));
  r.bars.push_back(tube({{1.0, 0.12, -0.42}, {1.0, 0.115, 0.42}}, 0.035));
  r.material = "steel";
  r.density = 1700;  // tubes, drawn solid
  r.weight = 0.4;
  r.tags = {"steel", "rail"};
  return r;
}

Recipe bar_cluster(const char* name, double weight) {
  Recipe r;
  r.name = name;
  r.material = "steel";
  r.weight = weight;
  r.tags = {"steel", "rebar", "cluster"};
  return r;
}

// The cage of a column: four long bars and ties around them, twisted.
Recipe rebar_cage() {
  RandomStream random = piece_stream("rebar_cage");
  Recipe r = bar_cluster("rebar_cage", 0.3);
  const auto corner = [&](double x, int i) {
    const double half = 0.12, turn = 0.5 * x;
    const double y = i & 1 ? half : -half, z = i & 2 ? half : -half;
    const double sag = 0.12 * x * x;
    return Vec3{x, y - turn * z + 0.05 * x, z + turn * y + sag - 0.06};
  };
  for (int i = 0; i < 4; ++i) {
    const double tip = random.uniform(-0.04, 0.12);
    r.bars.push_back({{corner(-0.8 - tip, i), corner(-0.35, i), corner(0.2, i),
                       corner(0.75 + tip, i) + random.direction() * 0.05},
                      0.009, 0, true});
  }
  for (const double x : {-0.62, -0.38, -0.1, 0.16, 0.42, 0.66}) {
    const int order[6] = {0, 1, 3, 2, 0, 1};
    Bar tie{{}, 0.005, 0, false};
    const double lean = random.uniform(-0.06, 0.06);
    for (int k = 0; k < 5; ++k) {
      Vec3 p = corner(x + lean * (order[k] & 1 ? 1 : -1), order[k]);
      const Vec3 axis = (corner(x, 0) + corner(x, 3)) * 0.5;
      tie.line.push_back(p + normalized(p - axis) * 0.013);
    }
    r.bars.push_back(tie);
  }
  return r;
}

// Bars torn out together: a bundle that fans out and curls.
Recipe rebar_tangle() {
  RandomStream random = piece_stream("rebar_tangle");
  Recipe r = bar_cluster("rebar_tangle", 0.4);
  for (int i = 0; i < 7; ++i) {
    Vec3 p{-0.55, random.uniform(-0.03, 0.03), random.uniform(-0.03, 0.03)};
    Vec3 along = normalized(Vec3{1, random.uniform(-0.25, 0.25), random.uniform(-0.2, 0.2)});
    Bar bar{{p}, 0.0065, 0, true};
    for (int k = 0; k < 4; ++k) {
      p += along * random.uniform(0.2, 0.36);
      bar.line.push_back(p);
      const double curl = random.uniform(0.1, 0.55);
      along = normalized(along + random.direction() * curl);
    }
    r.bars.push_back(bar);
  }
  return r;
}

// A welded mat, folded.
Recipe rebar_mat() {
  Recipe r = bar_cluster("rebar_mat", 0.3);
  const auto bend = [](double x, double y) {
    const double up = x > 0 ? 0.9 * x * x : 0.05 * x;
    return Vec3{x - (x > 0 ? 0.35 * x * x : 0), y + 0.06 * x * y, up - 0.12 + 0.08 * y * y};
  };
  for (double y = -0.45; y < 0.46; y += 0.15) {
    Bar bar{{}, 0.006, 0, true};
    for (const double x : {-0.62, -0.2, 0.1, 0.35, 0.66}) bar.line.push_back(bend(x, y));
    r.bars.push_back(bar);
  }
  for (double x = -0.55; x < 0.6; x += 0.15) {
    Bar bar{{}, 0.005, 0, false};
    for (const double y : {-0.52, 0.0, 0.52}) bar.line.push_back(bend(x, y) + Vec3{0, 0, 0.010});
    r.bars.push_back(bar);
  }
  return r;
}

}  // namespace

std::vector<Recipe> guard_pieces() {
  return {guard_rail("guard_rail", 2.0, 0, 0), guard_rail("guard_rail_bent", 2.2, 0.35, 0.6), guard_post()};
}

std::vector<Recipe> bridge_steel() {
  return {i_beam("steel_girder", 3.0, 0.12, false), i_beam("steel_girder_torn", 1.7, 0.25, true),
          bridge_rail(), rebar_cage(), rebar_tangle(), rebar_mat()};
}

}  // namespace rubble::generator
