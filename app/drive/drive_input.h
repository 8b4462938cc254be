// What a person asks of the driven camera in one simulation step, whatever it was asked with.
#pragma once

#include <vector>

#include "io/live/drive_commands.h"
#include "kernel/base/math.h"

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
  scans,      // likewise, what LiDARs measured last
  cameras,    // likewise, what cameras have in view
  voids,      // likewise, the map of voids
  moment,     // save this moment as a mission
  help,
  picture,    // save what the window shows
  quit,
};

struct DriveInput {
  // Held axes, range: -1 to 1. Turns are about the camera body's X, Y and Z axes: positive rolls to
  // the right, lowers the nose, turns left.
  double forward = 0, roll = 0, pitch = 0, yaw = 0;
  // Asked for in figures, besides; bounded by DriveLimits. In the camera body frame (X forward,
  // Y left, Z up); units: m/s, rad/s
  Vec3 linear, angular;
  Vec3 look_deg;                     // turned at once, by the mouse: about X, Y, Z; unit: degree
  std::vector<JointTrajectoryCommand> trajectories;  // for the joints of a robot, in the order in which they came
  std::vector<DriveAction> actions;  // in the order in which they came
};

}  // namespace rubble
