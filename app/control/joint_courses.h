// Where joints are to be at any time, by the trajectories that a program sent.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "io/live/drive_commands.h"
#include "kernel/model/robot.h"
#include "scripting/robots/robot_item.h"

namespace rubble {

class JointCourses {
 public:
  // The robot from `time` on. Each joint goes on from where it was asked to be by then, or from where it stands, to
  // the first point; between points on a straight line, or where both have velocities on the cubic that has them. At
  // the last it stays. Joints that are not named keep their courses; a trajectory without points ends all of them.
  // Throws InputError and changes nothing: no such joint, beyond its limits, times that do not rise, numbers of
  // positions that are not those of the joints; a robot that grows.
  void begin(const JointTrajectoryCommand& trajectory, const RobotModel& model, const RobotState& state, double time);
  void end() { courses_.clear(); }
  bool empty() const { return courses_.empty(); }

  // Joints and their names in the command.
  void ask(double time, RobotLeg& leg) const;

 private:
  struct Knot {
    double time = 0, position = 0, velocity = 0;
    bool smooth = false;  // whether the velocity was given
  };
  // At least one knot; times rise.
  using Course = std::vector<Knot>;
  static Knot at(const Course& course, double time);

  std::map<std::size_t, std::pair<std::string, Course>> courses_;  // by joint
};

}  // namespace rubble
