#include "assets/generator/car.h"

#include <cmath>

#include "assets/generator/noise.h"
#include "assets/generator/shapes.h"

namespace rubble::generator {
namespace {

constexpr Surface kPaint = Surface::car_paint;
constexpr Surface kDark = Surface::rubber;
constexpr Surface kPane = Surface::glass;
constexpr Surface kUnderside = Surface::steel_rusty;

// Of a compact saloon; unit: m
constexpr double kNose = 2.10, kTail = -2.10, kHalfWidth = 0.86;
constexpr double kSill = 0.24, kWaist = 0.93, kRoof = 1.43;
constexpr double kFrontAxle = 1.28, kRearAxle = -1.28, kWheelRadius = 0.31, kTrack = 0.74;
constexpr double kMiddle = 0.66;  // height of the asset's origin above the ground

double smooth_step(double low, double high, double x) {
  const double t = std::fmin(1.0, std::fmax(0.0, (x - low) / (high - low)));
  return t * t * (3 - 2 * t);
}

// 1 at the centre, falling off over `reach`, without transcendentals.
double bump(double distance, double reach) {
  const double q = distance * distance / (reach * reach);
  return 1 / ((1 + q) * (1 + q));
}

Warp make_warp(const CarDamage& d, std::uint32_t seed) {
  return [d, seed](const Vec3& p) {
    Vec3 q = p;
    // The front folds: what is ahead of the axle moves back, the bonnet buckles up in the middle.
    const double ahead = smooth_step(0.75, kNose, p.x);
    q.x -= d.front * ahead;
    if (p.z > 0.6) {
      q.z += 0.55 * d.front * bump(p.x - 1.25, 0.25) * smooth_step(0.6, 0.9, p.z);
      q.z -= 0.25 * d.front * smooth_step(1.5, 2.1, p.x);
    }
    // The roof: everything above the waist is pressed together, unevenly.
    const double above = smooth_step(kWaist - 0.12, kRoof, p.z);
    const double wave = 0.5 * fractal_noise(Vec3{p.x * 1.1, p.y * 1.3, 0.3}, 2, seed + 5);
    const double tilt = 1 + d.roof_tilt * p.x / 1.4 + 0.35 * wave;
    q.z -= std::fmin(0.62, std::fmax(0.0, d.roof * tilt)) * above;
    q.y += d.roof_shift * above;
    if (d.roof > 0.3) q.z -= 0.10 * smooth_step(0.6, kWaist, p.z) * bump(p.x - 1.3, 0.8);
    // The left side: a post or another car stands in it.
    const double hit = d.side * bump(p.x - 0.1, 0.55) * smooth_step(-0.75, kHalfWidth, p.y);
    q.y -= hit;
    q.x += 0.15 * hit * (p.x < 0.1 ? 1 : -1) * smooth_step(0.2, 0.9, std::fabs(p.x - 0.1));
    // Dents everywhere, larger high up, where things fell on it.
    const double depth = d.dents * (0.4 + 0.6 * smooth_step(0.4, 1.0, p.z));
    const Vec3 field{gradient_noise(p * 2.2, seed + 1), gradient_noise(p * 2.2, seed + 2),
                     gradient_noise(p * 2.6, seed + 3) - 0.3};
    q += field * depth;
    q.z -= kMiddle;
    return q;
  };
}

// The lower body up to the waist, the nose and the tail slanting in all ways.
Cell body_cell() {
  Cell cell = extruded_cell(1,
                            {{2.06, kSill + 0.06}, {1.85, kSill - 0.02}, {-1.9, kSill - 0.02},
                             {-2.06, kSill + 0.14}, {kTail, 0.55}, {-2.06, 0.98}, {-1.35, 1.02},
                             {0.95, 0.98}, {1.95, 0.78}, {kNose, 0.62}, {kNose, 0.42}},
                            -kHalfWidth, kHalfWidth, kPaint);
  for (const double side : {1.0, -1.0}) {
    cell.push_back({normalized(Vec3{0, side, 0.28}), 0.978, kPaint});   // shoulders lean in
    cell.push_back({normalized(Vec3{0, side, -0.35}), 0.71, kPaint});   // and so do the sills
    cell.push_back({normalized(Vec3{1, side * 0.55, 0}), 2.12, kPaint});  // corners of the nose
    cell.push_back({normalized(Vec3{-1, side * 0.45, 0}), 2.16, kPaint});
  }
  for (Face& f : cell)
    if (f.normal.z < -0.9) f.surface = kUnderside;
  return cell;
}

// Grown by `out`: the greenhouse above the waist, and with out < 0 the room inside it.
Cell cabin_cell(double out, Surface surface) {
  Cell cell = extruded_cell(1,
                            {{1.08, 0.88}, {0.28, 1.385}, {-0.1, kRoof}, {-0.6, kRoof},
                             {-1.02, 1.375}, {-1.72, 0.9}},
                            -0.9, 0.9, surface);
  for (const double side : {1.0, -1.0}) {
    cell.push_back({normalized(Vec3{0, side, 0.36}), 1.055, surface});
    cell.push_back({normalized(Vec3{0.0, side * 0.35, 1}), 1.46, surface});  // crowned roof
  }
  for (Face& f : cell) f.offset += out;
  return cell;
}

// The room: seats, knees and the bench fit in; its floor is deep, its sides are thin.
Cell room_cell() {
  Cell room = cabin_cell(-0.045, kDark);
  for (Face& f : room) {
    if (f.normal.z < -0.5) f.offset = -0.36;  // the floor
  }
  room.push_back({{1, 0, 0}, 0.78, kDark});
  room.push_back({{-1, 0, 0}, 1.32, kDark});
  room.push_back({{0, 1, 0}, 0.74, kDark});
  room.push_back({{0, -1, 0}, 0.74, kDark});
  return room;
}

void add_openings(Recipe& r) {
  // Side windows, right through the cabin: front and rear, with a post between.
  r.solid.hollows.push_back(extruded_cell(
      1, {{0.80, 0.985}, {0.24, 1.34}, {-0.27, 1.36}, {-0.31, 0.985}}, -0.9, 0.9, kPaint));
  r.solid.hollows.push_back(extruded_cell(
      1, {{-0.41, 0.985}, {-0.37, 1.36}, {-0.83, 1.345}, {-1.32, 1.0}}, -0.9, 0.9, kPaint));
  // Windscreen and rear window: through the slanted fronts, between the pillars.
  Cell screen = extruded_cell(0, {{-0.66, 0.985}, {0.66, 0.985}, {0.53, 1.35}, {-0.53, 1.35}}, 0.2,
                              1.3, kPaint);
  Cell rear = extruded_cell(0, {{-0.64, 1.02}, {0.64, 1.02}, {0.52, 1.34}, {-0.52, 1.34}}, -1.9,
                            -0.9, kPaint);
  r.solid.hollows.push_back(screen);
  r.solid.hollows.push_back(rear);
  // Wheel arches, open to the sides and below.
  for (const double x : {kFrontAxle, kRearAxle}) {
    for (const double y : {1.0, -1.0}) {
      r.solid.hollows.push_back(cylinder_cell(1, {x, 0, kWheelRadius}, kWheelRadius + 0.055,
                                              y > 0 ? 0.58 : -1.0, y > 0 ? 1.0 : -0.58, kDark));
    }
  }
}

// Grooves around the doors, the bonnet and the boot, as wide as the grid can show.
void add_seams(Recipe& r) {
  const double half = 0.009, deep = 0.022;
  const auto groove = [&](const Vec3& low, const Vec3& high) {
    r.solid.hollows.push_back(box_cell(low, high, kDark));
  };
  for (const double side : {1.0, -1.0}) {
    const double in = side > 0 ? kHalfWidth - deep : -1.0, out = side > 0 ? 1.0 : -kHalfWidth + deep;
    for (const double x : {0.86, -0.36, -1.16}) groove({x - half, in, 0.36}, {x + half, out, 0.9});
    groove({-1.16, in, 0.36 - half}, {0.86, out, 0.36 + half});
    groove({0.2, in, 0.78}, {0.02, out, 0.80});
    // Handles lie in shallow trays.
    for (const double x : {-0.2, -1.0}) groove({x - 0.09, in, 0.765}, {x + 0.09, out, 0.80});
  }
  // Bonnet and boot lid.
  for (const double y : {0.68, -0.68}) {
    groove({1.0, y - half, 0.74}, {1.92, y + half, 1.2});
    groove({-2.0, y - half, 0.93}, {-1.5, y + half, 1.2});
  }
  groove({1.03 - half, -0.68, 0.93}, {1.03 + half, 0.68, 1.2});
}

void add_trim(Recipe& r) {
  auto& cells = r.solid.cells;
  // Bumpers of dark plastic, lamps in the corners, a grille between them.
  cells.push_back(extruded_cell(1, {{2.02, 0.28}, {2.14, 0.32}, {2.15, 0.47}, {2.02, 0.5}}, -0.66,
                                0.66, kDark));
  cells.push_back(extruded_cell(1, {{-2.02, 0.32}, {-2.14, 0.36}, {-2.15, 0.5}, {-2.02, 0.53}},
                                -0.68, 0.68, kDark));
  cells.push_back(extruded_cell(1, {{2.0, 0.53}, {2.115, 0.53}, {2.1, 0.63}, {2.0, 0.66}}, -0.34,
                                0.34, kDark));
  for (const double side : {1.0, -1.0}) {
    const double in = side > 0 ? 0.40 : -0.68, out = side > 0 ? 0.68 : -0.40;
    cells.push_back(extruded_cell(1, {{1.9, 0.57}, {2.105, 0.57}, {2.06, 0.70}, {1.9, 0.73}}, in,
                                  out, kPane));
    cells.push_back(extruded_cell(1, {{-1.9, 0.68}, {-2.105, 0.68}, {-2.085, 0.84}, {-1.9, 0.86}},
                                  in - 0.01 * side, out, kPane));
  }
}

// Dashboard and mirrors: bodies of their own, since the room and the windows are cut from the body.
Recipe fittings(const Warp& warp) {
  Recipe r;
  r.solid.wear = steel_wear();
  r.solid.wear.edge_round = 0.03;
  r.solid.cells = {extruded_cell(1, {{0.48, 0.66}, {0.60, 0.92}, {0.98, 0.955}, {0.85, 0.6}}, -0.75,
                                 0.75, kDark)};
  for (const double side : {1.0, -1.0}) {
    r.solid.cells.push_back(box_cell({0.70, side > 0 ? 0.74 : -0.98, 0.95},
                                     {0.78, side > 0 ? 0.98 : -0.74, 1.07}, kPaint));
  }
  r.warp = warp;
  r.cell = 0.016;
  r.triangles = {600, 240, 90};
  r.collides = false;
  return r;
}

// Seats of cloth, with the same warp as the body.
Recipe seats(const Warp& warp) {
  Recipe r;
  r.solid.wear = fabric_wear();
  r.solid.wear.edge_round = 0.05;
  r.solid.seed = 77;
  const Surface cloth = Surface::fabric;
  const auto seat = [&](double x, double low_y, double high_y) {
    r.solid.cells.push_back(extruded_cell(
        1, {{x - 0.24, 0.33}, {x + 0.26, 0.33}, {x + 0.28, 0.56}, {x - 0.22, 0.5}}, low_y, high_y,
        cloth));
    r.solid.cells.push_back(extruded_cell(
        1, {{x - 0.30, 0.42}, {x - 0.14, 0.44}, {x - 0.32, 1.02}, {x - 0.44, 1.0}}, low_y, high_y,
        cloth));
  };
  for (const double y : {0.14, -0.62}) {
    seat(0.12, y, y + 0.48);
    r.solid.cells.push_back(extruded_cell(
        1, {{-0.34, 1.0}, {-0.22, 1.0}, {-0.28, 1.2}, {-0.37, 1.2}}, y + 0.12, y + 0.36, cloth));
  }
  seat(-0.75, -0.68, 0.68);
  r.warp = warp;
  r.cell = 0.02;
  r.triangles = {1500, 500, 200};
  r.max_edge = 0.2;
  r.fit_parts = false;
  return r;
}

// A tyre on its rim, which is sunk and holed.
Recipe wheel(const Vec3& hub, double side, const Warp& warp, RandomStream& random) {
  Recipe tyre;
  tyre.solid.wear = {0, 0.1, 0.02, 0.002, 0.035, 0, 0.02};
  const double half = 0.095;
  tyre.solid.cells = {cylinder_cell(1, hub, kWheelRadius, hub.y - half, hub.y + half, kDark)};
  const double dish = side > 0 ? hub.y + half - 0.05 : hub.y - half - 0.1;
  tyre.solid.hollows = {cylinder_cell(1, hub, 0.2, dish, dish + 0.15, Surface::steel_galvanised)};
  for (int i = 0; i < 5; ++i) {
    static const double kTurn[5][2] = {{0, 1}, {0.951, 0.309}, {0.588, -0.809}, {-0.588, -0.809},
                                       {-0.951, 0.309}};
    const Vec3 hole = hub + Vec3{kTurn[i][0], 0, kTurn[i][1]} * 0.125;
    tyre.solid.hollows.push_back(
        cylinder_cell(1, hole, 0.042, dish - (side > 0 ? 0.03 : 0), dish + (side > 0 ? 0.1 : 0.18),
                      kDark));
  }
  tyre.solid.seed = static_cast<std::uint32_t>(random.next() >> 40);
  const Vec3 moved = warp(hub) - hub;  // stiff: it moves as a whole, and leans
  const double lean = random.uniform(-0.18, 0.18), steer = random.uniform(-0.25, 0.25);
  const double shift = random.uniform(-0.03, 0.03);
  tyre.warp = [=](const Vec3& p) {
    const Vec3 d = p - hub;
    return hub + moved + Vec3{d.x - steer * d.y, d.y + steer * d.x + lean * d.z + shift, d.z - lean * d.y};
  };
  tyre.regions = {extruded_cell(1,
                                {{hub.x + 0.33, hub.z + 0.14}, {hub.x + 0.14, hub.z + 0.33},
                                 {hub.x - 0.14, hub.z + 0.33}, {hub.x - 0.33, hub.z + 0.14},
                                 {hub.x - 0.33, hub.z - 0.14}, {hub.x - 0.14, hub.z - 0.33},
                                 {hub.x + 0.14, hub.z - 0.33}, {hub.x + 0.33, hub.z - 0.14}},
                                hub.y - 0.12, hub.y + 0.12, kDark)};
  tyre.cell = 0.014;
  tyre.triangles = {900, 320, 140};
  tyre.max_edge = 0.1;
  return tyre;
}

// Panes as far as they held: the windscreen, crazed but in one piece, and the rear window.
void add_panes(Recipe& r, const CarDamage& d) {
  if (!d.windscreen) return;
  Recipe pane;
  pane.sheets = {quad_sheet({0.955, -0.66, 0.965}, {0.955, 0.66, 0.965}, {0.30, 0.53, 1.365},
                            {0.30, -0.53, 1.365}, 14, 9, 0.006, kPane)};
  pane.warp = r.warp;
  pane.triangles = {460, 200, 100};
  pane.collides = false;
  r.attached.push_back(pane);
}

// The doorway of an open car, and the bay below its bonnet.
void add_gaps(Recipe& r) {
  r.solid.hollows.push_back(extruded_cell(
      1, {{0.80, 0.40}, {0.80, 0.99}, {-0.31, 0.99}, {-0.31, 0.40}}, 0.6, 1.1, kDark));
  r.solid.hollows.push_back(extruded_cell(
      1, {{0.99, 0.80}, {0.99, 1.2}, {1.93, 1.2}, {1.93, 0.66}}, -0.64, 0.64, kDark));
}

// Convex regions of the body: front and rear block, floor, sides, pillars, roof.
std::vector<Cell> body_regions(bool open) {
  std::vector<Cell> regions;
  const auto add = [&](const Vec3& low, const Vec3& high) {
    regions.push_back(box_cell(low, high, kPaint));
  };
  if (!open) {
    add({0.77, -0.9, 0.1}, {1.45, 0.9, 1.15});
    add({1.45, -0.9, 0.1}, {2.2, 0.9, 1.15});
  } else {  // around the bay, its floor, and the nose
    add({0.77, -0.9, 0.1}, {1.0, 0.9, 1.15});
    add({0.99, -0.9, 0.1}, {1.47, 0.9, 0.79});
    add({1.46, -0.9, 0.1}, {1.94, 0.9, 0.72});
    for (const auto& x : {std::array<double, 2>{0.99, 1.47}, {1.46, 1.94}}) {
      add({x[0], 0.63, 0.65}, {x[1], 0.9, 1.15});
      add({x[0], -0.9, 0.65}, {x[1], -0.63, 1.15});
    }
    add({1.92, -0.9, 0.1}, {2.2, 0.9, 1.15});
  }
  add({-1.75, -0.9, 0.1}, {-1.30, 0.9, 1.1});
  add({-2.2, -0.9, 0.1}, {-1.75, 0.9, 1.1});
  for (const double x : {-1.31, -0.56, 0.19}) {
    const double high = x + 0.76;
    add({x, -0.9, 0.1}, {high, 0.9, 0.375});                // floor
    if (!open) add({x, 0.735, 0.36}, {high, 0.92, 0.985});  // sides
    add({x, -0.92, 0.36}, {high, -0.735, 0.985});
  }
  if (open) {  // before and behind the doorway
    add({-1.31, 0.735, 0.36}, {-0.32, 0.92, 0.985});
    add({0.81, 0.70, 0.36}, {0.95, 0.92, 0.985});
  }
  for (const double side : {1.0, -1.0}) {
    const auto pillar = [&](double x0, double x1, double x2, double x3) {
      Cell cell = extruded_cell(1, {{x0, 0.97}, {x1, 0.97}, {x2, 1.37}, {x3, 1.37}},
                                side > 0 ? 0.5 : -0.9, side > 0 ? 0.9 : -0.5, kPaint);
      regions.push_back(cell);
    };
    pillar(0.78, 1.02, 0.34, 0.18);
    pillar(-0.42, -0.30, -0.26, -0.38);
    pillar(-1.68, -1.30, -0.82, -1.02);
  }
  add({-0.42, -0.8, 1.33}, {0.4, 0.8, 1.5});
  add({-1.12, -0.8, 1.33}, {-0.42, 0.8, 1.5});
  return regions;
}

}  // namespace

namespace {

Recipe car_recipe(const CarDamage& damage, RandomStream& random) {
  Wear wear = steel_wear();
  wear.edge_round = 0.05, wear.cast_depth = 0.001;
  return plain_recipe(damage.name, random, "vehicle", wear, 0.017);
}

// A piece of bodywork that is bent as the car is.
Recipe bodywork(const CarDamage& damage, const char* name, const Cell& cell, double density) {
  RandomStream random = piece_stream(damage.name);
  Recipe r = car_recipe(damage, random);
  r.name = name;
  r.warp = make_warp(damage, r.solid.seed);
  r.solid.cells = {cell};
  r.regions = {cell};  // parts that are bent with it
  r.solid.wear.edge_round = 0.012;
  r.cell = 0.011;
  r.density = density;
  r.triangles = {2400, 900, 400};
  r.max_edge = 0.14;
  r.weight = 0;
  r.tags = {"vehicle", "car", "bodywork"};
  return r;
}

}  // namespace

Recipe make_car_door(const CarDamage& damage) {
  Cell leaf = body_cell();
  leaf.push_back({normalized(Vec3{0, -1, -0.28}), -0.898, kDark});  // inside
  leaf.push_back({{0, -1, 0}, -0.6, kDark});
  leaf.push_back({{1, 0, 0}, 0.785, kPaint});
  leaf.push_back({{-1, 0, 0}, 0.295, kPaint});
  leaf.push_back({{0, 0, 1}, 0.98, kPaint});
  leaf.push_back({{0, 0, -1}, -0.415, kPaint});
  return bodywork(damage, "car_door", leaf, 420);
}

Recipe make_car_bonnet(const CarDamage& damage) {
  Cell plate = extruded_cell(1, {{0.97, 0.99}, {0.97, 0.955}, {1.94, 0.755}, {1.94, 0.79}}, -0.68,
                             0.68, kPaint);
  Recipe r = bodywork(damage, "car_bonnet", plate, 300);
  r.regions.clear();  // it buckled: one convex part would fill the hollow
  for (const double x : {0.96, 1.28, 1.61}) {
    for (const double y : {-0.69, -0.01}) {
      Cell region = plate;
      region.push_back({{1, 0, 0}, x + 0.34, kPaint});
      region.push_back({{-1, 0, 0}, -x, kPaint});
      region.push_back({{0, 1, 0}, y + 0.70, kPaint});
      region.push_back({{0, -1, 0}, -y, kPaint});
      r.regions.push_back(region);
    }
  }
  return r;
}

Recipe make_car(const CarDamage& damage) {
  RandomStream random = piece_stream(damage.name);
  Recipe r = car_recipe(damage, random);
  r.solid.cells = {body_cell(), cabin_cell(0, kPaint)};
  add_trim(r);
  r.solid.hollows = {room_cell()};
  add_openings(r);
  add_seams(r);
  if (damage.open) add_gaps(r);
  r.warp = make_warp(damage, r.solid.seed);
  r.regions = body_regions(damage.open);
  add_panes(r, damage);
  r.attached.push_back(seats(r.warp));
  r.attached.push_back(fittings(r.warp));
  int left = damage.wheels;
  for (const double x : {kFrontAxle, kRearAxle}) {
    for (const double side : {1.0, -1.0}) {
      if (left-- <= 0) continue;
      r.attached.push_back(wheel({x, side * kTrack, kWheelRadius}, side, r.warp, random));
    }
  }
  r.density = 270;  // of the body's solid: about 1.2 t in all
  r.triangles = {9000, 3800, 2700};
  r.max_edge = 0.16;
  r.weight = damage.open ? 0 : 0.1;
  r.tags = {"vehicle", "car", "large"};
  return r;
}

}  // namespace rubble::generator
