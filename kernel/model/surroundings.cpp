#include "kernel/model/surroundings.h"

namespace rubble {

const std::array<std::string, kSurroundingKinds>& surrounding_names() {
  static const std::array<std::string, kSurroundingKinds> names{
      "road", "kerb",    "pavement",    "soil",   "building", "tree",
      "fence", "vehicle", "street_lamp", "puddle", "skyline"};
  return names;
}

}  // namespace rubble
