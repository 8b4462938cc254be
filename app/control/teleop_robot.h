// A robot that a person or a program drives: from what is asked of it, step by step, to commands of a mission.
#pragma once

#include <vector>

#include "app/control/joint_courses.h"
#include "kernel/robot/robot_run.h"
#include "scripting/robots/robot_kind.h"

namespace rubble {

class TeleopRobot {
 public:
  // keeps: all commands, for a mission that says them again; otherwise the last.
  explicit TeleopRobot(const RobotItem& item, bool keeps = true) : item_(item), keeps_(keeps) { restart(); }

  // What was asked so far is forgotten.
  void restart();
  // Holds until the next call.
  void ask(const TeleopCommand& asked) { asked_ = asked; }
  // From `time` on its joints go by that besides. Throws InputError as JointCourses::begin().
  void follow(const JointTrajectoryCommand& trajectory, const RobotModel& model, const RobotState& state, double time) {
    courses_.begin(trajectory, model, state, time);
  }
  // As a RobotController.
  RobotCommand control(const RobotSense& sense, const RobotModel& model);

  const RobotItem& item() const { return item_; }
  const std::vector<RobotLeg>& legs() const { return legs_; }  // at least one

 private:
  RobotItem item_;
  bool keeps_;
  std::vector<RobotLeg> legs_;
  TeleopCommand asked_;
  JointCourses courses_;
  double asked_at_ = 0;  // of the last command; unit: s
};

}  // namespace rubble
