// A spring and damper between a point of a piece and a point that the mouse moves.
//
// Soft constraint (Catto 2011, "Soft constraints"): before each step of the world the piece gets the impulse
//   p = -(K + gamma I)^-1 (v + k / (c + h k) x),  gamma = 1 / (h (c + h k)),  |p| <= F h
// where x is the way from the target to the point, v the point's velocity, K the response of the piece to impulses there
// and h the step. Without other forces this is the spring k and the damper c by the implicit Euler method, for any k.
#pragma once

#include <functional>
#include <optional>

#include "kernel/world/world.h"

namespace rubble {

struct MouseSpringOptions {
  double frequency = 4;   // of the piece alone on the spring; unit: Hz; > 0
  double damping = 1;     // 1: critical; unit: 1; >= 0
  double most_force = 20; // unit: weight of the piece under 9.81 m/s2; > 0
};

class MouseSpring {
 public:
  explicit MouseSpring(const MouseSpringOptions& options = {}) : options_(options) {}

  // Takes hold of a piece at a point of the world. False, and nothing is held: it is immovable or lost.
  bool grab(const World& world, int piece, const Vec3& point);
  void release() { held_.reset(); }
  bool holds() const { return held_.has_value(); }
  int piece() const { return held_->piece; }
  void pull_to(const Vec3& target) { target_ = target; }  // in the world; unit: m

  // Impulse for the next step; unit: N s
  Vec3 calc_impulse(const World& world, double step) const;
  Vec3 point(const World& world) const;  // where it holds the piece now
  const Vec3& target() const { return target_; }

 private:
  struct Held {
    int piece = 0;
    Vec3 in_body;     // the point, in the frame of the piece's type; unit: m
    double mass = 0;  // of what moves as one rigid body with it; unit: kg
  };
  MouseSpringOptions options_;
  std::optional<Held> held_;
  Vec3 target_;
};

}  // namespace rubble
