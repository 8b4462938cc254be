#include "app/control/teleop_robot.h"

#include "app/control/robot_control.h"

namespace rubble {

void TeleopRobot::restart() {
  legs_ = {kind_of(item_).still(item_)};
  asked_ = {};
  asked_at_ = 0;
  courses_.end();
}

RobotCommand TeleopRobot::control(const RobotSense& sense, const RobotModel& model) {
  RobotLeg leg = legs_.back();
  leg.t = sense.time;
  kind_of(item_).steer(asked_, item_, legs_.back(), sense.time - asked_at_, leg);
  courses_.ask(sense.time, leg);
  asked_at_ = sense.time;
  if (!same_command(leg, legs_.back())) {
    if (!keeps_ || leg.t <= legs_.back().t) legs_.pop_back();
    legs_.push_back(leg);
  }
  // As the mission that is kept will say it: by the last of them.
  return command_of_leg(item_, model, legs_.back(), sense.time);
}

}  // namespace rubble
