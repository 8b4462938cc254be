// A suite: missions, seeds, and what is expected of the datasets that they give.
//
//   return suite {
//     runs = {
//       { name = "heap", mission = "heap.lua", seeds = "1..5",
//         expect = { pile_height_m = { 0.5, 2 }, frames = { 30, 30 } } },
//     },
//   }
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "scripting/schema/schema.h"

namespace rubble {

// Which hashes must be those of the golden file.
enum class GoldenParts {
  none,
  pile,  // the state hash: the same on every machine
  all,   // frames and files, too: of the device `software` the same on every machine, of `gl` with one driver
};

struct SuiteRun {
  std::string name;                        // unique in the suite
  std::string mission;                     // path relative to the suite's
  std::string seeds;                       // "1..5"; empty: the mission's own
  std::vector<std::string> set;            // "key=value", as --set
  bool pile_only = false;                  // true: settles, and draws no frames
  GoldenParts golden = GoldenParts::pile;  // which hashes are compared
  // Limits of metrics, both included; by the index of the metric's name.
  std::vector<std::optional<NumberPair>> expect;
};

struct SuiteScript {
  std::string path;            // of the script
  std::vector<SuiteRun> runs;  // in the order of the script
};

// metrics: the names that `expect` may hold, with a line of explanation each. Throws InputError
// with every mistake.
SuiteScript load_suite(const std::string& path,
                       const std::vector<std::pair<std::string, std::string>>& metrics);

}  // namespace rubble
