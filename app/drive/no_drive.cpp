// `rubble drive` and `rubble inspect` where the library for it is missing.
#include "app/drive/drive_request.h"

namespace rubble {

ExitCode drive_mission(const DriveRequest&) {
  throw RunError("this program was built without SDL2 (libsdl2-dev), so it has no window to drive in");
}

ExitCode inspect_mission(const DriveRequest& request) { return drive_mission(request); }

}  // namespace rubble
