// What a person asked for on the command line.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace rubble {

struct RunRequest {
  std::string mission;                   // path of the Lua script
  std::optional<std::uint64_t> seed;     // --seed; overrides the script's
  std::vector<std::string> overrides;    // --set key=value, in order
  std::vector<std::string> asset_packs;  // --assets DIR, in order
  std::string out;                       // --out; empty: out/<name of the script>
  int threads = 0;                       // --threads; 0: all processors
  bool force = false;                    // --force: replace an earlier run's files
  bool quiet = false;                    // --quiet: no progress
};

}  // namespace rubble
