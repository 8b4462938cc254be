#include "app/drive/remote_controls.h"

#include <algorithm>

namespace rubble {
namespace {

constexpr float kPressed = 0.5f;      // of an axis that counts as two buttons

struct JoyStick {
  std::size_t axis;
  double DriveInput::*input;
  double sign;  // Joy's sticks are positive to the left and up
};

const JoyStick kSticks[] = {
    {1, &DriveInput::forward, 1},  // left stick
    {0, &DriveInput::roll, -1},
    {4, &DriveInput::pitch, -1},  // right stick
    {3, &DriveInput::yaw, 1},
};

struct JoyPad {
  std::size_t axis;
  DriveAction negative, positive;
};

const JoyPad kPads[] = {
    {6, DriveAction::fog_up, DriveAction::fog_down},
    {7, DriveAction::lamp_down, DriveAction::lamp_up},
};

struct Button {
  std::size_t number;
  DriveAction action;
};

const Button kJoyButtons[] = {
    {0, DriveAction::lamp},    {1, DriveAction::fog},     {2, DriveAction::help},
    {3, DriveAction::reset},   {4, DriveAction::slower},  {5, DriveAction::faster},
    {6, DriveAction::quit},    {7, DriveAction::pause},   {9, DriveAction::picture},
    {10, DriveAction::next_seed},
};

// Fewer axes or buttons than expected: those that are not there are not touched.
float axis_of(const JoyCommand& joy, std::size_t number) {
  return number < joy.axes.size() ? joy.axes[number] : 0;
}
bool pressed(const JoyCommand& joy, std::size_t number) {
  return number < joy.buttons.size() && joy.buttons[number] != 0;
}

}  // namespace

void RemoteControls::hear(const DriveCommands& commands, double seconds) {
  twist_age_ += seconds;
  if (!commands.twists.empty()) {
    twist_ = commands.twists.back();
    twist_age_ = 0;
  }
  if (twist_age_ > kTwistHolds) twist_ = {};
  for (const JoyCommand& joy : commands.joys) hear(joy);
  if (!commands.joy_connected) joy_ = {};
  trajectories_.insert(trajectories_.end(), commands.trajectories.begin(), commands.trajectories.end());
}

void RemoteControls::hear(const JoyCommand& joy) {
  for (const JoyPad& pad : kPads) {
    const float was = axis_of(joy_, pad.axis), is = axis_of(joy, pad.axis);
    if (is >= kPressed && was < kPressed) actions_.push_back(pad.positive);
    if (is <= -kPressed && was > -kPressed) actions_.push_back(pad.negative);
  }
  for (const Button& button : kJoyButtons)
    if (pressed(joy, button.number) && !pressed(joy_, button.number))
      actions_.push_back(button.action);
  joy_ = joy;
}

void RemoteControls::add_to(DriveInput& input) {
  input.linear += twist_.linear;
  input.angular += twist_.angular;
  for (const JoyStick& stick : kSticks) {
    double& value = input.*stick.input;
    value = std::clamp(value + stick.sign * double(axis_of(joy_, stick.axis)), -1.0, 1.0);
  }
  input.actions.insert(input.actions.end(), actions_.begin(), actions_.end());
  actions_.clear();
  input.trajectories.insert(input.trajectories.end(), trajectories_.begin(), trajectories_.end());
  trajectories_.clear();
}

}  // namespace rubble
