#include "assets/generator/noise.h"
#include "assets/generator/pieces.h"
#include "assets/generator/shapes.h"
#include "kernel/base/portable_math.h"

namespace rubble::generator {
namespace {

constexpr Surface kCloth = Surface::fabric;

Recipe wooden(const char* name, double cell) {
  RandomStream random = piece_stream(name);
  Recipe r = plain_recipe(name, random, "timber", timber_wear(), cell);
  r.solid.wear.edge_round = 0.006;
  r.max_edge = 0.12;
  r.tags = {"furniture", "timber"};
  return r;
}

// A kitchen chair about the middle of its seat's footprint, 0.9 m tall. broken: three legs, and the
// back torn off.
Recipe chair(const char* name, bool broken) {
  Recipe r = wooden(name, 0.006);
  RandomStream random = piece_stream(std::string(name) + "/breaks");
  const double seat = 0.0, floor = -0.45, top = broken ? 0.16 : 0.45, leg = 0.019, half = 0.19;
  auto& cells = r.solid.cells;
  cells.push_back(extruded_cell(2, {{-0.2, -0.2}, {0.21, -0.22}, {0.21, 0.22}, {-0.2, 0.2}},
                                seat - 0.014, seat + 0.014, kWood));
  for (const double x : {-half, half}) {
    for (const double y : {-half, half}) {
      if (broken && x > 0 && y > 0) continue;
      const bool back = x < 0;
      cells.push_back(box_cell({x - leg, y - leg, floor}, {x + leg, y + leg, back ? top : seat}, kWood));
      if (back && broken) {
        break_end(cells.back(), 2, 1, 0.8, Surface::timber_fracture, random);
      }
    }
  }
  r.solid.wear.along = {0, 0, 1};
  r.solid.wear.fracture_depth = 0.06;
  const auto rail = [&](const Vec3& low, const Vec3& high) {
    cells.push_back(box_cell(low, high, kWood));
  };
  for (const double x : {-half, half}) rail({x - 0.011, -half, -0.07}, {x + 0.011, half, -0.012});
  for (const double y : {-half, half}) {
    const bool stump = broken && y > 0;  // the leg that held its far end is gone
    rail({-half, y - 0.011, -0.07}, {stump ? 0.1 : half, y + 0.011, -0.012});
    if (!stump) rail({-half, y - 0.011, -0.3}, {half, y + 0.011, -0.272});
  }
  for (const auto& z : {std::array<double, 2>{0.36, 0.44}, {0.2, 0.25}, {0.08, 0.12}}) {
    if (!broken) rail({-half - 0.012, -half, z[0]}, {-half + 0.012, half, z[1]});
  }
  r.triangles = {3600, 1000, 300};
  r.weight = 0.7;
  r.tags.push_back("chair");
  return r;
}

// 1.4 x 0.8 x 0.75 m, about its middle. broken: half of it, with two legs.
Recipe table(const char* name, bool broken) {
  Recipe r = wooden(name, 0.008);
  const double half_x = 0.7, half_y = 0.4, top = 0.375, leg = 0.03;
  auto& cells = r.solid.cells;
  r.solid.wear.fracture_depth = 0.10;
  cells.push_back(box_cell({-half_x, -half_y, top - 0.032}, {half_x, half_y, top}, kWood));
  if (broken) {
    cells[0].push_back({normalized(Vec3{1, 0.3, 0}), 0.12, Surface::timber_fracture});
    cells[0].push_back({normalized(Vec3{1, -0.5, 0}), 0.2, Surface::timber_fracture});
  }
  for (const double x : {-half_x + 0.06, half_x - 0.06}) {
    if (broken && x > 0) continue;
    for (const double y : {-half_y + 0.06, half_y - 0.06}) {
      cells.push_back(box_cell({x - leg, y - leg, -top}, {x + leg, y + leg, top - 0.02}, kWood));
    }
    cells.push_back(box_cell({x - 0.011, -half_y + 0.07, top - 0.12},
                             {x + 0.011, half_y - 0.07, top - 0.02}, kWood));
  }
  for (const double y : {-half_y + 0.06, half_y - 0.06}) {
    Cell apron = box_cell({-half_x + 0.07, y - 0.011, top - 0.12},
                          {half_x - 0.07, y + 0.011, top - 0.02}, kWood);
    if (broken) apron.push_back({normalized(Vec3{1, 0, 0.7}), 0.15, Surface::timber_fracture});
    cells.push_back(apron);
  }
  r.triangles = {3600, 1000, 260};
  r.weight = 0.4;
  r.tags.push_back("table");
  return r;
}

Recipe cushioned(const char* name, double density) {
  RandomStream random = piece_stream(name);
  Recipe r = plain_recipe(name, random, "furniture", fabric_wear(), 0.014);
  r.density = density;
  r.max_edge = 0.14;
  r.tags = {"furniture", "fabric"};
  return r;
}

// 1.9 x 0.86 x 0.8 m: base, back, arms and loose cushions on wooden feet.
Recipe sofa() {
  Recipe r = cushioned("sofa", 90);
  auto& cells = r.solid.cells;
  const auto add = [&](const Vec3& low, const Vec3& high) {
    cells.push_back(box_cell(low, high, kCloth));
  };
  add({-0.40, -0.80, -0.32}, {0.42, 0.80, -0.08});                                // base
  for (const double y : {-1.0, 1.0}) {
    add({-0.42, y > 0 ? 0.76 : -0.95, -0.34}, {0.43, y > 0 ? 0.95 : -0.76, 0.2});  // arms
    add({-0.2, y > 0 ? 0.0 : -0.77, -0.11}, {0.45, y > 0 ? 0.77 : 0.0, 0.06});    // seats
    const Outline leaning{{-0.22, -0.02}, {-0.03, 0.0}, {-0.14, 0.42}, {-0.30, 0.40}};
    cells.push_back(extruded_cell(1, leaning, y > 0 ? 0.01 : -0.76, y > 0 ? 0.76 : -0.01, kCloth));
  }
  cells.push_back(extruded_cell(1, {{-0.43, -0.33}, {-0.2, -0.33}, {-0.22, 0.33}, {-0.43, 0.33}},
                                -0.80, 0.80, kCloth));  // back
  for (const double x : {-0.34, 0.34}) {
    for (const double y : {-0.85, 0.85}) {
      Recipe foot;
      foot.solid.wear = timber_wear();
      foot.solid.cells = {box_cell({x - 0.03, y - 0.03, -0.4}, {x + 0.03, y + 0.03, -0.325}, kWood)};
      foot.cell = 0.01;
      foot.triangles = {120, 50, 12};
      r.attached.push_back(foot);
    }
  }
  r.triangles = {5200, 1400, 560};
  r.weight = 0.15;
  r.tags.push_back("large");
  return r;
}

// 1.9 x 0.9 x 0.18 m, sagging over whatever it lies on, quilted.
Recipe mattress() {
  Recipe r = cushioned("mattress", 45);
  r.solid.wear.cast_depth = 0.005;
  const double half = 0.085;
  r.solid.cells = {box_cell({-0.95, -0.45, -half}, {0.95, 0.45, half}, kCloth)};
  for (int i = 0; i < 4; ++i) {
    const double low = -0.97 + 0.485 * i;
    r.regions.push_back(box_cell({low, -0.47, -half - 0.02}, {low + 0.485, 0.47, half + 0.02}, kCloth));
  }
  r.warp = [half](const Vec3& p) {
    // Tufts at the crossings of a lattice draw the faces in.
    const auto wave = [](double x) { return 0.5 + 0.5 * portable::cos(2 * portable::kPi * x / 0.19); };
    const double tuft = 0.011 * wave(p.x) * wave(p.y + 0.095);
    const double z = p.z * (1 - tuft / half);
    const double bend = 0.16 * p.x * p.x - 0.05 * p.x * p.y;
    return Vec3{p.x * (1 - 0.03 * p.x * p.x), p.y, z + bend - 0.05};
  };
  r.triangles = {5200, 1300, 240};
  r.weight = 0.3;
  return r;
}

// 0.6 x 0.62 x 1.75 m, hollow in look only: two doors with their gaps, handles and a plinth, dented.
Recipe refrigerator() {
  RandomStream random = piece_stream("refrigerator");
  Recipe r = plain_recipe("refrigerator", random, "steel", steel_wear(), 0.009);
  r.solid.wear.edge_round = 0.018;
  r.density = 115;
  const Surface enamel = Surface::car_paint;
  r.solid.cells = {box_cell({-0.31, -0.3, -0.83}, {0.25, 0.3, 0.875}, enamel),
                   box_cell({-0.28, -0.27, -0.875}, {0.22, 0.27, -0.82}, Surface::rubber),
                   box_cell({0.262, -0.3, -0.83}, {0.315, 0.3, 0.31}, enamel),
                   box_cell({0.262, -0.3, 0.325}, {0.315, 0.3, 0.875}, enamel),
                   box_cell({0.24, -0.28, -0.81}, {0.27, 0.28, 0.855}, Surface::rubber)};
  for (const auto& z : {std::array<double, 2>{0.36, 0.6}, {0.0, 0.28}}) {
    Recipe grip;
    grip.solid.wear = steel_wear();
    grip.solid.cells = {box_cell({0.31, 0.235, z[0]}, {0.355, 0.26, z[1]}, Surface::steel_galvanised)};
    grip.solid.hollows = {box_cell({0.30, 0.2, z[0] + 0.03}, {0.335, 0.3, z[1] - 0.03},
                                   Surface::steel_galvanised)};
    grip.cell = 0.006;
    grip.triangles = {400, 140, 40};
    grip.collides = false;
    r.attached.push_back(grip);
  }
  const std::uint32_t seed = r.solid.seed;
  r.warp = [seed](const Vec3& p) {  // a side pushed in, a corner bent, small dents all over
    const Vec3 blow = p - Vec3{0, 0.3, 0.25};
    const double near = dot(blow, blow) / 0.07;
    const double push = 0.06 / ((1 + near) * (1 + near));
    const double small = 0.004 * fractal_noise(p * 7.0, 2, seed);
    const double lean = p.z > 0.5 ? 0.12 * (p.z - 0.5) * (p.z - 0.5) : 0;
    return Vec3{p.x + small + lean, p.y - push + small, p.z - 0.5 * lean};
  };
  for (const auto& z : {std::array<double, 2>{-0.89, -0.1}, {-0.1, 0.45}, {0.45, 0.89}}) {
    r.regions.push_back(box_cell({-0.33, -0.32, z[0]}, {0.33, 0.32, z[1]}, enamel));
  }
  r.triangles = {4600, 1100, 120};
  r.max_edge = 0.12;
  r.weight = 0.2;
  r.tags = {"appliance", "steel"};
  return r;
}

}  // namespace

std::vector<Recipe> furniture_pieces() {
  return {chair("chair", false), chair("chair_broken", true), table("table", false),
          table("table_broken", true), sofa(), mattress(), refrigerator()};
}

}  // namespace rubble::generator
