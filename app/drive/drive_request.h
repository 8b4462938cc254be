// What a person asked `rubble drive` for on the command line.
#pragma once

#include <string>

#include "app/support/run_request.h"
#include "kernel/base/error.h"

namespace rubble {

struct DriveRequest {
  RunRequest of;                 // the mission; out: folder of what is driven
  int width = 480, height = 360;  // --size, of the colour image; unit: pixel
  int steps = 0;                 // --steps: ends after so many; 0: when the person quits
  bool record = false;           // --record: the mission's recordings, while driving
  std::string robot;             // --robot: which of the mission's is driven; empty: the first
};

// The mission's world to be looked at, stopped and pulled at in a window: docs/how_to/inspect.md. Only `of`, size and steps
// (pictures) count.
ExitCode inspect_mission(const DriveRequest& request);
// The mission's pile to be driven through in a window: docs/how_to/drive.md.
ExitCode drive_mission(const DriveRequest& request);

}  // namespace rubble
