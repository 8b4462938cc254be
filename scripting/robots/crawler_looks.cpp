#include "scripting/robots/crawler.h"

#include <algorithm>

#include "kernel/base/portable_math.h"
#include "scripting/robots/link_shapes.h"

namespace rubble {
namespace {

constexpr int kBeltArc = 14, kWheelFacets = 22;
constexpr double kLugHeight = 0.010, kFlipperLugHeight = 0.007, kBeltThickness = 0.006;  // unit: m

// The outlines of a belt's outside and inside below its lugs, from the rear axle along X.
Outline belt_outline(const TrackSize& size, double depth) {
  return make_belt_outline(size.radius_rear - depth, size.radius_front - depth, size.length, kBeltArc);
}

// A lug across the belt from y = from to y = to, slanted by `slant` along the belt. It is as high as the hull.
void add_lug(const OutlineSpot& spot, double height, double foot, double top, double from, double to, double slant,
             const Pose& at, MeshBuilder& out) {
  const Vec3 &n = spot.normal, t{n.z, 0, -n.x};
  const auto corner = [&](double along, double y, double up) {
    const double shift = along + slant * (y - from) / (to - from);
    return spot.position + t * shift + n * up + Vec3{0, y, 0};
  };
  const double chamfer = (from < to ? 0.5 : -0.5) * (foot - top);
  const double low = -0.4 * kBeltThickness, in = from + chamfer, end = to - chamfer;
  std::array<Vec3, 8> p{corner(-foot, from, low), corner(foot, from, low),  corner(foot, to, low),
                        corner(-foot, to, low),   corner(-top, in, height), corner(top, in, height),
                        corner(top, end, height), corner(-top, end, height)};
  if (from > to) {
    std::swap(p[0], p[1]), std::swap(p[2], p[3]);
    std::swap(p[4], p[5]), std::swap(p[6], p[7]);
  }
  add_block(p, at, out);
}

void add_belt(const TrackSize& size, double lug_height, int lugs, const Pose& at, MeshBuilder& out) {
  const double half = 0.5 * size.width;
  const Outline outer = belt_outline(size, lug_height), inner = belt_outline(size, lug_height + kBeltThickness);
  out.look("rubber");
  add_band(outer, inner, -half + 0.001, half - 0.001, at, out);
  out.look("polymer_black");
  for (int k = 0; k < lugs; ++k) {
    // Two rows of slanted lugs, half a pitch apart, and a short one between them.
    const OutlineSpot left = find_outline_spot(outer, (k + 0.25) / lugs),
                      right = find_outline_spot(outer, (k + 0.75) / lugs);
    const double foot = 0.45 * lug_height + 0.0025, top = 0.0035;
    add_lug(left, lug_height, foot, top, 0.06 * size.width, half, 0.006, at, out);
    add_lug(right, lug_height, foot, top, -0.06 * size.width, -half, 0.006, at, out);
    // Teeth inside, which run between the wheels' halves.
    if (k % 3 == 0) {
      const OutlineSpot tooth = find_outline_spot(inner, (k + 0.5) / lugs);
      add_lug({tooth.position, -tooth.normal}, 0.6 * lug_height, 0.006, 0.003, -0.07 * size.width, 0.07 * size.width, 0,
              at, out);
    }
  }
}

// A wheel under a belt: a rim, spokes, a hub; bolts at the side that looks along X of `at`, which is its axis.
void add_track_wheel(double radius, double width, int spokes, const Pose& at, MeshBuilder& out) {
  const double half = 0.5 * width, r = radius;
  out.look("polymer_black");
  add_collar({{-half, 0.76 * r}, {-half, 0.97 * r}, {-half + 0.03 * r, r}, {half, r}, {half, 0.76 * r}}, kWheelFacets,
             at, out);
  add_lathe({{-half + 0.012, 0.8 * r}, {half - 0.012, 0.8 * r}}, kWheelFacets, at, out);
  out.look("aluminium");
  for (int k = 0; k < spokes; ++k) {
    const auto [s, c] = portable::sincos(portable::kPi * k / spokes);
    const Pose spoke = at * Pose{{c, s, 0, 0}, {}};
    const double in = 0.16 * r, end = 0.8 * r, foot = 0.08 * r, top = 0.055 * r, up = half - 0.004;
    add_block({Vec3{-up, in, -foot}, Vec3{-up, end, -foot}, Vec3{-up, end, foot}, Vec3{-up, in, foot},
               Vec3{up, in, -top}, Vec3{up, end, -top}, Vec3{up, end, top}, Vec3{up, in, top}},
              spoke, out);
  }
  add_lathe({{-half, 0.24 * r}, {half - 0.004, 0.27 * r}, {half, 0.2 * r}}, 16, at, out);
  out.look("steel_galvanised");
  add_bolt_circle(0.86 * r, spokes, 0.04 * r, at * Pose{{}, {half, 0, 0}}, out);
}

// A small wheel that the belt runs over, with a rubber tread.
void add_roller(double radius, double width, const Pose& at, MeshBuilder& out) {
  const double half = 0.5 * width, r = radius;
  out.look("rubber");
  add_collar({{-half, 0.7 * r}, {-half + 0.05 * r, r}, {half - 0.05 * r, r}, {half, 0.7 * r}}, 14, at, out);
  out.look("aluminium");
  add_lathe({{-half + 0.003, 0.72 * r}, {half - 0.003, 0.72 * r}}, 14, at, out);
  add_lathe({{-half - 0.001, 0.3 * r}, {half + 0.001, 0.3 * r}}, 8, at, out);
}

// The plate between the wheels at the side that looks out.
void add_side_plate(double length, double height, double from, double to, double side, const Pose& at,
                    MeshBuilder& out) {
  Outline plate = make_belt_outline(0.5 * height, 0.5 * height, length, 8);
  for (Vec3& p : plate) p.x -= 0.5 * length;
  out.look("aluminium");
  add_slab(plate, std::min(side * from, side * to), std::max(side * from, side * to), 0.0025, at, out);
  out.look("polymer_black");
  Outline inlay = make_belt_outline(0.27 * height, 0.27 * height, 0.62 * length, 8);
  for (Vec3& p : inlay) p.x -= 0.31 * length;
  const double a = side * (to - 0.002), b = side * (to + 0.0015);
  add_slab(inlay, std::min(a, b), std::max(a, b), 0.0008, at, out);
  out.look("steel_galvanised");
  for (const double x : {-0.44, 0.44}) {
    add_bolt(0.0042, at * facing({1.2 * x * length, side * to, 0}, {0, side, 0}), out);
    for (const double z : {-0.35, 0.35})
      add_bolt(0.0042, at * facing({x * length, side * to, z * height}, {0, side, 0}), out);
  }
}

}  // namespace

TriangleMesh make_track_looks(const TrackSize& size, double y, double side) {
  MeshBuilder out;
  const double r = size.radius_rear, half = 0.5 * size.width, inside = r - kLugHeight - kBeltThickness;
  out.frame({{}, {0, y, r}});
  add_belt(size, kLugHeight, 40, {{}, {-0.5 * size.length, 0, 0}}, out);
  for (const double x : {-0.5, 0.5}) {
    const Pose axle = facing({x * size.length, 0, 0}, {0, side, 0});
    add_track_wheel(inside - 0.0005, size.width - 0.012, 6, axle, out);
    // What the flipper hangs on.
    out.look("steel_galvanised");
    add_lathe({{half - 0.03, 0.022}, {half + 0.006, 0.022}, {half + 0.009, 0.019}}, 16,
              facing({x * size.length, 0, 0}, {0, side, 0}), out);
  }
  const double low = 0.024, high = 0.015;
  for (int k = 0; k < 5; ++k) {
    const double x = (k - 2) * 0.068;
    add_roller(low, size.width - 0.02, facing({x, 0, -inside + low}, {0, 1, 0}), out);
    if (k % 2 == 1) add_roller(high, size.width - 0.02, facing({x, 0, inside - high}, {0, 1, 0}), out);
  }
  out.look("polymer_black");
  add_chamfered_box({0.36, size.width - 0.03, 0.058}, {0, 0, 0.004}, 0.008, {}, out);
  add_side_plate(0.27, 0.058, half - 0.017, half - 0.006, side, {{}, {0, 0, 0.008}}, out);
  return out.take_smooth(kLooksCrease);
}

TriangleMesh make_flipper_looks(const TrackSize& size, double direction, double side) {
  MeshBuilder out;
  const double half = 0.5 * size.width, hub = size.radius_rear - kFlipperLugHeight - kBeltThickness,
               tip = size.radius_front - kFlipperLugHeight - kBeltThickness;
  // Built along +X; turned about Z for the rear, which swaps its sides.
  if (direction < 0) out.frame({{0, 0, 0, 1}, {}});
  const double outwards = side * direction;
  add_belt(size, kFlipperLugHeight, 30, {}, out);
  add_track_wheel(hub - 0.0005, size.width - 0.01, 5, facing({}, {0, outwards, 0}), out);
  add_track_wheel(tip - 0.0005, size.width - 0.01, 5, facing({size.length, 0, 0}, {0, outwards, 0}), out);
  out.look("polymer_black");
  add_slab(make_belt_outline(0.55 * hub, 0.6 * tip, size.length, 8), -half + 0.012, half - 0.012, 0.004, {}, out);
  for (const double y : {-1.0, 1.0}) {
    // A plate from hub to tip.
    out.look("car_paint");
    const double a = y * (half - 0.013), b = y * (half - 0.003);
    Outline plate = make_belt_outline(0.44 * hub, 0.5 * tip, size.length, 8);
    add_slab(plate, std::min(a, b), std::max(a, b), 0.002, {}, out);
    if (y != outwards) continue;
    out.look("polymer_black");
    for (int k = 0; k < 3; ++k) {
      const double share = 0.28 + 0.2 * k, radius = (0.44 * hub * (1 - share) + 0.5 * tip * share) * 0.62;
      add_lathe({{-0.003, radius}, {0.0008, radius}}, 14, facing({share * size.length, b, 0}, {0, y, 0}), out);
    }
    out.look("steel_galvanised");
    for (const double x : {0.0, size.length}) {
      const Pose axle = facing({x, b, 0}, {0, y, 0});
      const double radius = x > 0 ? 0.011 : 0.02;
      add_lathe({{-0.004, radius}, {0.0015, radius}, {0.0025, 0.85 * radius}}, 16, axle, out);
      add_bolt_circle(0.62 * radius, 5, 0.13 * radius, axle * Pose{{}, {0.0025, 0, 0}}, out);
    }
  }
  // Its axle reaches to the track's.
  out.look("steel_galvanised");
  add_lathe({{half - 0.01, 0.018}, {half + 0.008, 0.018}}, 16, facing({}, {0, -outwards, 0}), out);
  return out.take_smooth(kLooksCrease);
}

namespace {

// Hull between the tracks with a sloped nose, a lid, rails, panels at both ends.
void add_crawler_hull(MeshBuilder& out) {
  out.look("polymer_black");
  add_slab({{-0.28, 0, 0.075},
            {-0.258, 0, 0.052},
            {0.245, 0, 0.052},
            {0.28, 0, 0.085},
            {0.28, 0, 0.148},
            {0.235, 0, 0.188},
            {-0.262, 0, 0.188},
            {-0.28, 0, 0.17}},
           -0.14, 0.14, 0.006, {}, out);
  out.look("car_paint");
  add_chamfered_box({0.44, 0.225, 0.02}, {-0.015, 0, 0.194}, 0.006, {}, out);
  out.look("aluminium");
  for (const double side : {-1.0, 1.0}) {
    add_chamfered_box({0.46, 0.014, 0.014}, {-0.015, side * 0.127, 0.191}, 0.003, {}, out);
    for (const double x : {-0.14, 0.14})
      add_chamfered_box({0.07, 0.03, 0.035}, {x, side * 0.146, 0.12}, 0.006, {}, out);
  }
  add_chamfered_box({0.008, 0.22, 0.05}, {0.2805, 0, 0.117}, 0.002, {}, out);
  add_chamfered_box({0.008, 0.23, 0.07}, {-0.2805, 0, 0.118}, 0.002, {}, out);
  out.look("steel_galvanised");
  for (const double y : {-0.103, 0.103}) {
    for (const double x : {-0.2, -0.1, 0.0, 0.1, 0.17}) add_bolt(0.0035, facing({x, y, 0.204}, {0, 0, 1}), out);
    for (const double z : {0.1, 0.134}) add_bolt(0.0035, facing({0.2845, y, z}, {1, 0, 0}), out);
    for (const double z : {0.092, 0.144}) add_bolt(0.0035, facing({-0.2845, y, z}, {-1, 0, 0}), out);
  }
}

// Tow eye and lamps in front; sockets and a battery's door at the rear.
void add_crawler_ends(MeshBuilder& out) {
  for (const double y : {-0.07, 0.07}) add_lamp(0.017, facing({0.2845, y, 0.117}, {1, 0, 0}), out);
  out.look("steel_galvanised");
  add_pipe({{0.28, -0.02, 0.112}, {0.304, -0.02, 0.112}, {0.304, 0.02, 0.112}, {0.28, 0.02, 0.112}}, 0.005, 0.012, 10,
           {}, out);
  add_pipe({{-0.28, -0.02, 0.098}, {-0.302, -0.02, 0.098}, {-0.302, 0.02, 0.098}, {-0.28, 0.02, 0.098}}, 0.005, 0.012,
           10, {}, out);
  out.look("polymer_black");
  add_chamfered_box({0.006, 0.09, 0.03}, {-0.286, 0, 0.132}, 0.002, {}, out);
  for (const double y : {-0.08, 0.08}) {
    add_lathe({{0, 0.013}, {0.008, 0.013}, {0.010, 0.011}}, 14, facing({-0.2845, y, 0.12}, {-1, 0, 0}), out);
    out.look("aluminium");
    add_lathe({{0.009, 0.007}, {0.014, 0.007}}, 10, facing({-0.2845, y, 0.12}, {-1, 0, 0}), out);
    out.look("polymer_black");
  }
}

// A camera between two lamps, on two legs. What rides at {0.3, 0, 0.3} sees over it.
void add_crawler_head(MeshBuilder& out) {
  out.look("aluminium");
  for (const double y : {-0.06, 0.06}) add_chamfered_box({0.03, 0.012, 0.04}, {0.215, y, 0.213}, 0.003, {}, out);
  add_chamfered_box({0.066, 0.182, 0.006}, {0.2425, 0, 0.2765}, 0.0025, {}, out);
  out.look("polymer_black");
  add_chamfered_box({0.055, 0.17, 0.05}, {0.24, 0, 0.25}, 0.006, {}, out);
  add_lens(0.018, facing({0.2665, 0, 0.25}, {1, 0, 0}), out);
  for (const double y : {-0.054, 0.054}) add_lamp(0.02, facing({0.2665, y, 0.25}, {1, 0, 0}), out);
  out.look("polymer_black");
  add_pipe({{0.215, 0.03, 0.24}, {0.19, 0.03, 0.235}, {0.18, 0.03, 0.2}}, 0.004, 0.012, 8, {}, out);
}

// A laser scanner on four posts, vents, a handle, two aerials, a stop button, a radio's box.
void add_crawler_deck(MeshBuilder& out) {
  const double deck = 0.2035;
  out.look("aluminium");
  add_chamfered_box({0.12, 0.12, 0.008}, {0, 0, deck + 0.003}, 0.002, {}, out);
  add_chamfered_box({0.12, 0.12, 0.006}, {0, 0, 0.303}, 0.002, {}, out);
  for (const double x : {-0.048, 0.048})
    for (const double y : {-0.048, 0.048}) {
      add_pipe({{x, y, deck}, {x, y, 0.302}}, 0.005, 0, 12, {}, out);
      add_bolt(0.004, facing({x, y, 0.306}, {0, 0, 1}), out);
    }
  add_scanner(0.0515, 0.066, {{}, {0, 0, 0.306}}, out);
  out.look("polymer_black");
  add_chamfered_box({0.075, 0.075, 0.04}, {0, 0, 0.226}, 0.006, {}, out);
  for (int k = 0; k < 8; ++k)
    add_chamfered_box({0.006, 0.13, 0.007}, {-0.205 + 0.013 * k, 0, deck + 0.002}, 0.002, {}, out);
  add_chamfered_box({0.07, 0.05, 0.03}, {0.115, 0.065, 0.217}, 0.005, {}, out);
  add_stop_button({{}, {0.12, -0.07, deck}}, out);
  out.look("polymer_black");
  add_pipe({{-0.245, -0.085, 0.18}, {-0.245, -0.085, 0.252}, {-0.245, 0.085, 0.252}, {-0.245, 0.085, 0.18}}, 0.008,
           0.025, 12, {}, out);
  for (const double y : {-0.115, 0.115}) add_aerial(0.14, {{}, {-0.25, y, 0.187}}, out);
}

}  // namespace

TriangleMesh make_crawler_body_looks() {
  MeshBuilder out;
  add_crawler_hull(out);
  add_crawler_ends(out);
  add_crawler_head(out);
  add_crawler_deck(out);
  return out.take_smooth(kLooksCrease);
}

}  // namespace rubble
