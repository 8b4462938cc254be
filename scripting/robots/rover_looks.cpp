#include "scripting/robots/rover.h"

#include <algorithm>

#include "kernel/base/portable_math.h"
#include "scripting/robots/link_shapes.h"

namespace rubble {
namespace {

constexpr int kTyreFacets = 40, kTreadPitches = 22;
constexpr double kTreadDepth = 0.0075;  // unit: m

// A block of tread: from `in` to `end` along the axle, its top at these radii, turned on by `turn` of a pitch.
struct TreadBlock {
  double in = 0, end = 0;                // unit: m
  double radius_in = 0, radius_end = 0;  // of its top; unit: m
  double turn_in = 0, turn_end = 0;      // unit: pitches
  double length = 0;                     // round the tyre; unit: pitches
};

void add_tread_block(const TreadBlock& block, int pitch, double floor, const Pose& wheel, MeshBuilder& out) {
  const auto corner = [&](double x, double turn, double radius) {
    const auto [s, c] = portable::sincos(2 * portable::kPi * (pitch + turn) / kTreadPitches);
    return Vec3{x, radius * c, radius * s};
  };
  const double half = 0.5 * block.length, top = 0.84 * half, edge = block.in < block.end ? 0.0012 : -0.0012;
  const double in = block.turn_in, end = block.turn_end;
  std::array<Vec3, 8> p{corner(block.in, in - half, floor),
                        corner(block.end, end - half, floor),
                        corner(block.end, end + half, floor),
                        corner(block.in, in + half, floor),
                        corner(block.in + edge, in - top, block.radius_in),
                        corner(block.end - edge, end - top, block.radius_end),
                        corner(block.end - edge, end + top, block.radius_end),
                        corner(block.in + edge, in + top, block.radius_in)};
  if (block.in < block.end) {
    std::swap(p[0], p[1]), std::swap(p[2], p[3]);
    std::swap(p[4], p[5]), std::swap(p[6], p[7]);
  }
  add_block(p, wheel, out);
}

// A carcass with rows of blocks: two slanted ones in the middle, one on each shoulder.
void add_tyre(double radius, double width, const Pose& wheel, MeshBuilder& out) {
  const double r = radius, h = 0.5 * width, floor = r - kTreadDepth;
  out.look("rubber");
  add_collar({{-0.80 * h, 0.64 * r},
              {-0.92 * h, 0.67 * r},
              {-0.97 * h, 0.74 * r},
              {-0.96 * h, 0.82 * r},
              {-0.90 * h, 0.89 * r},
              {-0.72 * h, floor},
              {-0.30 * h, floor + 0.001},
              {0.30 * h, floor + 0.001},
              {0.72 * h, floor},
              {0.90 * h, 0.89 * r},
              {0.96 * h, 0.82 * r},
              {0.97 * h, 0.74 * r},
              {0.92 * h, 0.67 * r},
              {0.80 * h, 0.64 * r}},
             kTyreFacets, wheel, out);
  out.look("polymer_black");
  for (int k = 0; k < kTreadPitches; ++k) {
    for (const double side : {-1.0, 1.0}) {
      const double shift = side > 0 ? 0.5 : 0;
      add_tread_block({side * 0.04 * h, side * 0.46 * h, r, r, shift, shift + 0.28, 0.52}, k, floor - 0.003, wheel,
                      out);
      add_tread_block({side * 0.54 * h, side * 0.99 * h, 0.998 * r, 0.93 * r, shift + 0.42, shift + 0.5, 0.56}, k,
                      0.86 * r, wheel, out);
    }
  }
}

// Six double spokes on a barrel; dark behind them.
void add_rim(double radius, double width, const Pose& wheel, MeshBuilder& out) {
  const double r = radius, h = 0.5 * width;
  out.look("aluminium");
  add_collar({{-0.84 * h, 0.60 * r},
              {-0.84 * h, 0.665 * r},
              {-0.78 * h, 0.68 * r},
              {-0.7 * h, 0.65 * r},
              {0.7 * h, 0.65 * r},
              {0.78 * h, 0.68 * r},
              {0.84 * h, 0.665 * r},
              {0.84 * h, 0.60 * r},
              {0.5 * h, 0.57 * r},
              {-0.5 * h, 0.57 * r}},
             kTyreFacets, wheel, out);
  for (int k = 0; k < 6; ++k) {
    for (const double aside : {-0.075, 0.075}) {
      const auto [s, c] = portable::sincos(portable::kPi * k / 6);
      const Pose spoke = wheel * Pose{{c, s, 0, 0}, {}};
      const double in = 0.6 * aside * r, end = 1.5 * aside * r, thick = 0.035 * r;
      add_block({Vec3{0.30 * h, 0.16 * r, in - thick}, Vec3{0.30 * h, 0.61 * r, end - thick},
                 Vec3{0.30 * h, 0.61 * r, end + thick}, Vec3{0.30 * h, 0.16 * r, in + thick},
                 Vec3{0.72 * h, 0.16 * r, in - 0.7 * thick}, Vec3{0.58 * h, 0.61 * r, end - 0.7 * thick},
                 Vec3{0.58 * h, 0.61 * r, end + 0.7 * thick}, Vec3{0.72 * h, 0.16 * r, in + 0.7 * thick}},
                spoke, out);
    }
  }
  add_lathe({{-0.95 * h, 0.22 * r}, {-0.9 * h, 0.26 * r}, {0.74 * h, 0.26 * r}, {0.8 * h, 0.235 * r}}, 28, wheel, out);
  out.look("polymer_black");
  add_lathe({{-0.72 * h, 0.5 * r}, {-0.66 * h, 0.59 * r}, {0.1 * h, 0.59 * r}}, kTyreFacets, wheel, out);
  add_lathe({{0.7 * h, 0.125 * r}, {0.88 * h, 0.125 * r}, {0.92 * h, 0.1 * r}}, 20, wheel, out);
  out.look("steel_galvanised");
  add_bolt_circle(0.185 * r, 6, 0.028 * r, wheel * Pose{{}, {0.8 * h, 0, 0}}, out);
  add_bolt_circle(0.43 * r, 8, 0.03 * r, wheel * facing({-0.72 * h, 0, 0}, {-1, 0, 0}), out);
}

void add_rover_chassis(MeshBuilder& out) {
  out.look("paint_yellow");
  add_slab({{-0.21, 0, 0.088},
            {-0.192, 0, 0.067},
            {0.192, 0, 0.067},
            {0.21, 0, 0.088},
            {0.21, 0, 0.148},
            {0.186, 0, 0.184},
            {-0.186, 0, 0.184},
            {-0.21, 0, 0.148}},
           -0.134, 0.134, 0.006, {}, out);
  out.look("aluminium");
  add_chamfered_box({0.36, 0.24, 0.008}, {0, 0, 0.0695}, 0.003, {}, out);
  out.look("polymer_black");
  add_chamfered_box({0.356, 0.244, 0.008}, {0, 0, 0.187}, 0.0025, {}, out);
  for (const double side : {-1.0, 1.0}) {
    // Panels with slots on the sides; stubs of the axles.
    add_chamfered_box({0.075, 0.006, 0.06}, {0, side * 0.1345, 0.118}, 0.002, {}, out);
    for (const double x : {-0.131, 0.131}) {
      add_lathe({{0, 0.034}, {0.006, 0.034}, {0.009, 0.03}}, 18, facing({x, side * 0.133, 0.098}, {0, side, 0}), out);
    }
    out.look("aluminium");
    for (int k = 0; k < 3; ++k)
      add_chamfered_box({0.055, 0.004, 0.005}, {0, side * 0.1375, 0.103 + 0.015 * k}, 0.001, {}, out);
    for (const double x : {-0.131, 0.131})
      add_lathe({{0, 0.016}, {0.025, 0.016}}, 14, facing({x, side * 0.135, 0.098}, {0, side, 0}), out);
    out.look("polymer_black");
  }
}

// Bumpers of bent tube, lamps, rear lights and sockets.
void add_rover_ends(MeshBuilder& out) {
  for (const double end : {-1.0, 1.0}) {
    out.look("polymer_black");
    add_pipe({{end * 0.19, -0.1, 0.1}, {end * 0.218, -0.1, 0.1}, {end * 0.218, 0.1, 0.1}, {end * 0.19, 0.1, 0.1}},
             0.009, 0.02, 12, {}, out);
    add_chamfered_box({0.006, 0.19, 0.042}, {end * 0.2105, 0, 0.128}, 0.002, {}, out);
    out.look("steel_galvanised");
    for (const double y : {-0.045, 0.045})
      for (const double z : {0.115, 0.141}) add_bolt(0.003, facing({end * 0.2135, y, z}, {end, 0, 0}), out);
  }
  for (const double y : {-0.07, 0.07}) {
    add_lamp(0.0165, facing({0.2135, y, 0.13}, {1, 0, 0}), out);
    out.look("paint_red");
    add_chamfered_box({0.006, 0.03, 0.012}, {-0.215, y, 0.135}, 0.002, {}, out);
  }
  out.look("aluminium");
  for (const double y : {-0.016, 0.016})
    add_lathe({{0, 0.009}, {0.006, 0.009}, {0.007, 0.007}}, 12, facing({-0.2135, y, 0.128}, {-1, 0, 0}), out);
}

// Two cameras on a bracket in front, a laser scanner in the middle, a computer's case behind. What rides at
// {0.2, 0, 0.25} is just before the lenses, and z = 0.3 is free all round.
void add_rover_deck(MeshBuilder& out) {
  const double deck = 0.191;
  out.look("aluminium");
  for (const double y : {-0.105, 0.105}) add_chamfered_box({0.33, 0.018, 0.012}, {0, y, deck + 0.004}, 0.002, {}, out);
  add_chamfered_box({0.006, 0.09, 0.05}, {0.15, 0, deck + 0.022}, 0.0015, {}, out);
  add_chamfered_box({0.03, 0.09, 0.005}, {0.162, 0, deck + 0.001}, 0.0015, {}, out);
  out.look("polymer_black");
  add_chamfered_box({0.034, 0.125, 0.03}, {0.169, 0, 0.243}, 0.006, {}, out);
  for (const double y : {-0.044, 0.044}) add_lens(0.011, facing({0.1855, y, 0.243}, {1, 0, 0}), out);
  add_lamp(0.008, facing({0.1855, 0, 0.243}, {1, 0, 0}), out);
  out.look("polymer_black");
  add_pipe({{0.155, -0.03, 0.232}, {0.13, -0.03, 0.225}, {0.12, -0.03, 0.185}}, 0.003, 0.012, 8, {}, out);
  add_lathe({{-0.004, 0.05}, {0.02, 0.05}, {0.026, 0.044}}, 28, facing({0.03, 0, deck}, {0, 0, 1}), out);
  add_scanner(0.038, 0.056, {{}, {0.03, 0, deck + 0.025}}, out);
  out.look("paint_light");
  add_chamfered_box({0.11, 0.15, 0.05}, {-0.108, 0, deck + 0.024}, 0.006, {}, out);
  out.look("polymer_black");
  for (int k = 0; k < 5; ++k)
    add_chamfered_box({0.06, 0.006, 0.003}, {-0.108, -0.028 + 0.014 * k, deck + 0.0495}, 0.001, {}, out);
  for (const double side : {-1.0, 1.0}) {
    add_pipe({{-0.06, side * 0.118, 0.18},
              {-0.06, side * 0.118, 0.222},
              {-0.16, side * 0.118, 0.222},
              {-0.16, side * 0.118, 0.18}},
             0.0055, 0.015, 10, {}, out);
  }
  add_stop_button({{}, {0.1, -0.07, deck}}, out);
  add_aerial(0.09, {{}, {-0.172, 0.1, deck}}, out);
  out.look("steel_galvanised");
  for (const double x : {-0.168, 0.168})
    for (const double y : {-0.085, 0.085}) add_bolt(0.0035, facing({x, y, deck}, {0, 0, 1}), out);
}

}  // namespace

TriangleMesh make_rover_wheel_looks(double radius, double width, double side) {
  MeshBuilder out;
  const Pose wheel = facing({}, {0, side, 0});
  add_tyre(radius, width, wheel, out);
  add_rim(radius, width, wheel, out);
  return out.take_smooth(kLooksCrease);
}

TriangleMesh make_rover_body_looks() {
  MeshBuilder out;
  add_rover_chassis(out);
  add_rover_ends(out);
  add_rover_deck(out);
  return out.take_smooth(kLooksCrease);
}

}  // namespace rubble
