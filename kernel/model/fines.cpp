#include "kernel/model/fines.h"

namespace rubble {

const std::array<std::string, kFineKinds>& fine_names() {
  static const std::array<std::string, kFineKinds> names{"grit",  "plaster", "glass", "paper",
                                                         "cloth", "dust",    "cable", "pipe"};
  return names;
}

}  // namespace rubble
