// Counts how often a robot drives into what is too high to be driven over.
#pragma once

#include <functional>
#include <vector>

#include "kernel/model/robot.h"

namespace rubble {

class CollisionCounter {
 public:
  // pieces: of the pile; contacts with others are with the ground or the robot itself. step_height: see note(); unit: m.
  // is_solid: whether a place in the world is inside of a piece.
  CollisionCounter(int pieces, double step_height, std::function<bool(const Vec3&)> is_solid);

  // Contacts of a step of the simulation. One counts where a link presses, and what it presses against is higher there than
  // step_height above the base. base: on the robot's ground, in the world; unit: m.
  void note(const std::vector<RobotContact>& contacts, const Vec3& base);
  // What goes on from the period before is no new collision.
  void begin_period();

  int count() const { return count_; }  // periods in which a collision began

 private:
  bool is_collision(const RobotContact& contact, double highest_step) const;

  int pieces_;
  double step_height_;
  std::function<bool(const Vec3&)> is_solid_;
  bool pressed_ = false, pressed_before_ = false;  // in this period, in the one before
  int count_ = 0;
};

}  // namespace rubble
