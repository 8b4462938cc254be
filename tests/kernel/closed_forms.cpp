#include "closed_forms.h"

#include <cmath>

#include "kernel/base/portable_math.h"

namespace rubble::testing {

WorldOptions awake_options() {
  WorldOptions options;
  options.sleeping = false;
  return options;
}

WorldOptions weightless_options() {
  WorldOptions options = awake_options();
  options.gravity = 0;
  return options;
}

PieceType drum_type(double radius, double width, int facets) {
  PieceType type;
  type.name = "drum";
  type.friction = 0.8;
  ConvexPart part;
  for (double y : {-width / 2, width / 2}) {
    for (int k = 0; k < facets; ++k) {
      const auto [s, c] = portable::sincos(2 * portable::kPi * (k + 0.5) / facets);
      part.points.push_back({radius * s, y, -radius * c});
    }
  }
  type.parts = {part};
  return type;
}

double calc_apothem(double radius, int facets) { return radius * std::cos(portable::kPi / facets); }

namespace {

// One Runge-Kutta step of fourth order of angle'' = acceleration(angle).
template <typename Acceleration>
void advance(double& angle, double& spin, double dt, const Acceleration& acceleration) {
  const double a1 = acceleration(angle);
  const double a2 = acceleration(angle + 0.5 * dt * spin);
  const double a3 = acceleration(angle + 0.5 * dt * (spin + 0.5 * dt * a1));
  const double a4 = acceleration(angle + dt * (spin + 0.5 * dt * a2));
  angle += dt * spin + dt * dt / 6 * (a1 + a2 + a3);
  spin += dt / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
}

}  // namespace

double calc_prism_rolling(double radius, int facets, double slope, double seconds) {
  const double turn = 2 * portable::kPi / facets;
  const double about_axis = (2 + std::cos(turn)) / 6, about_edge = about_axis + 1;  // over m r^2
  const double kept = (about_axis + std::cos(turn)) / about_edge;
  const double side = 2 * radius * std::sin(turn / 2);
  const double pull = kG / (radius * about_edge);
  const auto acceleration = [&](double lean) { return pull * std::sin(lean + slope); };
  double lean = -turn / 2, spin = 0, distance = 0;  // lean: of the radius to the edge
  const double dt = 2e-5;
  for (double time = 0; time < seconds; time += dt) {
    advance(lean, spin, dt, acceleration);
    if (lean < -turn / 2) return distance;  // fell back: it lies on its facet
    if (lean < turn / 2) continue;
    lean -= turn;
    spin *= kept;
    distance += side;
  }
  return distance + side * (lean / turn + 0.5);
}

double Toppling::calc_time(double angle) const {
  const double dt = 1e-5;
  double turned = 0, rate = spin;
  const auto acceleration = [&](double a) {
    return kG * (x * std::cos(a) + z * std::sin(a)) / gyration_squared;
  };
  for (double time = 0; time < 60; time += dt) {
    if (turned >= angle) return time;
    if (turned < 0) break;
    advance(turned, rate, dt, acceleration);
  }
  return INFINITY;
}

Toppling topple_box(double width, double height, double tilt) {
  const double s = std::sin(tilt), c = std::cos(tilt);
  Toppling t;
  t.x = (height * s - width * c) / 2;
  t.z = (height * c + width * s) / 2;
  t.gyration_squared = (width * width + height * height) / 3;
  return t;
}

double tilt_of(const World& world, int piece) {
  const Quat q = world.piece(piece).world_from_body.rotation;
  return 2 * std::atan2(q.w < 0 ? -q.y : q.y, std::abs(q.w));
}

double measure_tilt_time(World& world, int piece, double angle, double limit) {
  const double start = world.time();
  double last = tilt_of(world, piece);
  while (world.time() - start < limit) {
    const double before = world.time();
    world.step();
    const double now = tilt_of(world, piece);
    if (now >= angle) {
      return before + (world.time() - before) * (angle - last) / (now - last) - start;
    }
    last = now;
  }
  return INFINITY;
}

}  // namespace rubble::testing
