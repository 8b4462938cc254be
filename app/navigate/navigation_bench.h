// MRPT's navigator over the piles of many seeds, and the table of what became of it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/eval/scores/score_table.h"
#include "app/navigate/navigation_run.h"
#include "app/support/run_request.h"

namespace rubble {

struct NavigationBenchRequest {
  RunRequest of;                // the mission; `seed` is not looked at; out: the folder
  std::string seeds = "1..10";  // --seeds
  std::string planner = "none";  // --planner: none or ompl
  bool missions_only = false;   // --missions-only: missions for `rubble drive` are written, and nothing drives
};

struct NavigationResult {
  std::uint64_t seed = 0;
  NavigationScore score;
};

// Settles the pile of each seed and drives through it; the way of each mission goes into ways/SEED.csv, and the mission
// as `rubble drive` opens it into missions/SEED.lua. Seeds whose piles have no void for the crawler are left out; `note` is
// told of them and of each mission. With missions_only scores are empty. Throws InputError and RunError.
std::vector<NavigationResult> run_navigation_bench(const NavigationBenchRequest& request,
                                                   const std::function<void(const std::string&)>& note);

// Means over the missions, some with their confidence intervals. with_clock: also what depends on this machine.
std::vector<ScoreRow> make_navigation_table(const std::vector<NavigationResult>& results, bool with_clock);
// One row for each mission.
std::vector<ScoreRow> list_missions(const std::vector<NavigationResult>& results);

}  // namespace rubble
