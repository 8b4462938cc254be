#include "kernel/model/fines.h"

#include <stdexcept>

namespace rubble {

const std::array<std::string, kFineKinds>& fine_names() {
  static const std::array<std::string, kFineKinds> names{"grit",  "plaster", "glass", "paper",
                                                         "cloth", "dust",    "cable", "pipe"};
  return names;
}

const std::vector<FineHeap>& Fines::heaps() const {
  static const std::vector<FineHeap> none;
  if (!gathered && !empty()) throw std::logic_error("fines without heaps: heap_fines() makes them");
  return gathered ? *gathered : none;
}

}  // namespace rubble
