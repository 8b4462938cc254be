// What this program was built from, for `rubble info` and the manifest.
#pragma once

#include <map>
#include <string>

namespace rubble {

struct BuildInfo {
  std::string version;                           // of Rubble
  std::string commit;                            // of the sources; "unknown" outside a git checkout
  std::string compiler;                          // name and version
  std::string flags;                             // of the compiler
  std::string target;                            // processor and system
  std::map<std::string, std::string> libraries;  // name to version
  // "reference" where Simbody computes what the determinism contract is made for, or "other": see
  // kernel/multibody/simbody_build.h. Empty in manifests that do not say.
  std::string simbody_bits;
};

BuildInfo build_info();

}  // namespace rubble
