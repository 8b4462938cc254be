// `rubble voids` where the libraries for it are missing.
#include "app/commands/commands.h"

namespace rubble {

ExitCode map_voids(const FolderRequest&, const VoidRequest&) {
  throw RunError("this program was built without Embree 3, so it has no void maps");
}

}  // namespace rubble
