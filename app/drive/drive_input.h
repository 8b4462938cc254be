// What a person or a program asks of the driven camera or robot in one simulation step, whatever it was asked with.
#pragma once

#include <vector>

#include "io/live/drive_commands.h"
#include "kernel/base/math.h"
#include "scripting/robots/robot_kind.h"

namespace rubble {

enum class DriveAction {
  lamp,       // on or off
  lamp_up,    // a quarter more power
  lamp_down,  // a fifth less
  fog,        // on or off
  fog_up,     // a quarter more
  fog_down,   // a fifth less
  faster,
  slower,
  reset,      // back to the entry
  next_seed,  // another pile
  pause,
  one_step,   // while it is paused
  slow,       // a quarter of the speed of time, a sixteenth, whole again
  hulls,      // shown or not
  contacts,   // likewise, with their forces
  frames,     // likewise, of the robots' links
  scans,      // likewise, what was scanned last
  cameras,    // likewise, what cameras have in view
  voids,      // likewise, the map of voids
  moment,     // save this moment as a mission
  help,
  picture,    // save what the window shows
  quit,
};

struct DriveInput : TeleopCommand {  // its `speed` is the camera's or the robot's, not asked for here
  Vec3 look_deg;                     // turned at once, by the mouse: about X, Y, Z; unit: degree
  std::vector<JointTrajectoryCommand> trajectories;  // for the joints of a robot, in the order in which they came
  std::vector<DriveAction> actions;  // in the order in which they came

  // Whether anything is to move.
  bool moves() const {
    return forward != 0 || roll != 0 || pitch != 0 || yaw != 0 || norm(linear) > 0 || norm(angular) > 0 || norm(look_deg) > 0 ||
           !trajectories.empty();
  }
};

}  // namespace rubble
