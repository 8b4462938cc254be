// The robots of a world: driven articulated pieces, which never sleep.
#pragma once

#include <vector>

#include "kernel/model/robot.h"
#include "kernel/world/world.h"

namespace rubble {

// Links of robots are pieces with consecutive numbers and types of their own. A piece wakes when a robot touches it.
class World::Robots {
 public:
  // Returns the number of the robot. world_from_base: pose of the first link's frame. Throws InputError for an invalid
  // model.
  int add(const RobotModel& model, const Pose& world_from_base);
  int count() const;
  int first_piece(int robot) const;  // the number of its first link
  const RobotModel& model(int robot) const;
  // Holds until the next command. Targets are clamped to the limits of joints and belts. Throws InputError for a
  // target that is not a number.
  void set_command(int robot, const RobotCommand& command);
  RobotState state(int robot) const;
  // Contacts of the last step with an impulse or an overlap, by link.
  std::vector<RobotContact> contacts(int robot) const;

 private:
  friend class World;
  explicit Robots(Impl& world) : impl_(&world) {}

  Impl* impl_;
};

}  // namespace rubble
