#include "scripting/robots/snake.h"

#include <algorithm>

#include "kernel/base/portable_math.h"
#include "scripting/robots/link_shapes.h"

namespace rubble {
namespace {

constexpr int kModuleFacets = 18;

// Rubber about a joint, which looks the same however it is bent.
void add_bellows(double radius, MeshBuilder& out) {
  constexpr int kRings = 8;
  std::vector<Ring> rings;
  for (int k = 0; k <= kRings; ++k) {
    const auto [s, c] = portable::sincos(portable::kPi * k / kRings);
    rings.push_back({-radius * c, k == 0 || k == kRings ? 0 : radius * s});
  }
  out.look("polymer_black");
  add_lathe(rings, kModuleFacets, {}, out);
}

// An end of a case, from x = 0 backwards into it.
void add_end_cap(double r, double depth, const Pose& at, MeshBuilder& out) {
  out.look("aluminium");
  add_lathe({{-depth, 0.975 * r}, {-0.35 * depth, 0.975 * r}, {-0.1 * depth, 0.9 * r}, {0, 0.76 * r}}, kModuleFacets,
            at, out);
  out.look("polymer_black");
  for (int k = 0; k < 4; ++k) {
    const auto [s, c] = portable::sincos(portable::kPi * (0.25 + 0.5 * k));
    add_lathe({{-0.05 * r, 0.075 * r}, {0.012 * r, 0.075 * r}}, 6,
              at * facing({-0.68 * depth, 0.965 * r * c, 0.965 * r * s}, {0, c, s}), out);
  }
}

// A skin with ribs between two ends.
void add_skin(double r, double from, double to, MeshBuilder& out) {
  constexpr int kRibs = 3;
  std::vector<Ring> rings{{from, 0.92 * r}};
  for (int k = 0; k < kRibs; ++k) {
    const double pitch = (to - from) / kRibs, x = from + k * pitch;
    for (const Ring& ring : {Ring{0.12, 0.925}, {0.24, 0.985}, {0.76, 0.985}, {0.88, 0.925}})
      rings.push_back({x + ring.x * pitch, ring.radius * r});
  }
  rings.push_back({to, 0.92 * r});
  out.look("polymer_black");
  add_lathe(rings, kModuleFacets, {}, out);
}

// Two arms that hold the joint at x = 0 of `at`, from a case that ends at x = reach; the joint turns about Y.
void add_fork(double r, double reach, const Pose& at, MeshBuilder& out) {
  const double round = 0.34 * r;
  Outline arm{{reach + 0.1 * r, 0, -round}, {reach + 0.1 * r, 0, round}};
  for (int k = 0; k <= 10; ++k) {
    const auto [s, c] = portable::sincos(portable::kPi * (0.5 + 0.1 * k));
    arm.push_back({round * c, 0, round * s});
  }
  out.look("aluminium");
  for (const double side : {-1.0, 1.0})
    add_slab(arm, std::min(side * 0.72, side * 0.86) * r, std::max(side * 0.72, side * 0.86) * r, 0.03 * r, at, out);
}

// Ends of the output shaft, which come out of the arms of the fork.
void add_horns(double r, const Pose& at, MeshBuilder& out) {
  for (const double side : {-1.0, 1.0}) {
    const Pose shaft = at * facing({}, {0, side, 0});
    out.look("polymer_black");
    add_lathe({{0.6 * r, 0.22 * r}, {0.9 * r, 0.21 * r}}, 12, shaft, out);
    out.look("steel_galvanised");
    add_bolt(0.09 * r, shaft * Pose{{}, {0.905 * r, 0, 0}}, out);
  }
}

// A camera behind glass in a ring of light-emitting diodes. Its mount ends at x = 0.
void add_snake_eye(double r, const Pose& at, MeshBuilder& out) {
  out.look("aluminium");
  add_collar({{-0.3 * r, 0.62 * r},
              {-0.3 * r, 0.975 * r},
              {-0.2 * r, 0.975 * r},
              {-0.08 * r, 0.9 * r},
              {0.02 * r, 0.74 * r},
              {0.02 * r, 0.66 * r}},
             28, at, out);
  out.look("polymer_black");
  add_lathe({{-0.28 * r, 0.65 * r}, {-0.1 * r, 0.65 * r}}, 28, at, out);
  out.look("paint_light");
  for (int k = 0; k < 8; ++k) {
    const auto [s, c] = portable::sincos(2 * portable::kPi * (k + 0.5) / 8);
    add_lathe({{-0.12 * r, 0.07 * r}, {-0.06 * r, 0.07 * r}, {-0.02 * r, 0.04 * r}}, 10,
              at * Pose{{}, {0, 0.5 * r * c, 0.5 * r * s}}, out);
  }
  out.look("aluminium");
  add_collar(
      {{-0.15 * r, 0.27 * r}, {-0.15 * r, 0.36 * r}, {0.03 * r, 0.36 * r}, {0.06 * r, 0.33 * r}, {0.06 * r, 0.28 * r}},
      24, at, out);
  out.look("pane");
  add_lathe({{-0.12 * r, 0.29 * r}, {0, 0.29 * r}, {0.035 * r, 0.2 * r}, {0.05 * r, 0}}, 24, at, out);
}

// Where the tether comes out behind; from x = 0 backwards.
void add_tether_plug(double r, const Pose& at, MeshBuilder& out) {
  out.look("aluminium");
  add_lathe({{-0.05 * r, 0.42 * r}, {0.2 * r, 0.42 * r}, {0.24 * r, 0.38 * r}}, 6, at, out);
  out.look("polymer_black");
  add_lathe({{0.2 * r, 0.3 * r}, {0.5 * r, 0.28 * r}, {0.8 * r, 0.17 * r}}, 16, at, out);
  out.look("rubber");
  add_pipe({{0.7 * r, 0, 0}, {1.25 * r, 0, 0}}, 0.13 * r, 0, 12, at, out);
}

}  // namespace

TriangleMesh make_snake_module_looks(const SnakeModuleSize& size, bool front_axis_z, bool head, bool tail) {
  MeshBuilder out;
  const double r = size.radius, gap = 0.19 * size.length, from = size.to - size.length + gap,
               to = size.to - (head ? 0.1 * r : gap), depth = std::min(0.3 * r, 0.3 * (to - from));
  // Turns Y to Z.
  const Pose about_z{{0.7071067811865476, 0.7071067811865476, 0, 0}, {}};
  add_skin(r, from + 0.8 * depth, to - 0.8 * depth, out);
  add_end_cap(r, depth, facing({from, 0, 0}, {-1, 0, 0}), out);
  if (head) {
    add_snake_eye(r, {{}, {to, 0, 0}}, out);
  } else {
    add_end_cap(r, depth, {{}, {to, 0, 0}}, out);
    add_bellows(0.75 * r, out);
    add_horns(r, front_axis_z ? about_z : Pose{}, out);
  }
  const Pose behind{{}, {size.to - size.length, 0, 0}};
  if (tail) {
    add_tether_plug(r, facing({from, 0, 0}, {-1, 0, 0}), out);
  } else {
    add_fork(r, gap, front_axis_z ? behind : behind * about_z, out);
  }
  return out.take_smooth(kLooksCrease);
}

}  // namespace rubble
