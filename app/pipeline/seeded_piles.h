// The piles of one mission with many seeds, one after the other, in memory.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/mission/resolved_mission.h"
#include "app/support/run_request.h"
#include "kernel/base/error.h"
#include "kernel/model/pile_state.h"

namespace rubble {

struct SeededPile {
  std::uint64_t seed = 0;
  const ResolvedMission& mission;
  const PileState& state;  // settled, or as the time limit left it
  int threads = 1;
};

struct SeededPiles {
  RunRequest of;                     // the mission; `seed` is not looked at
  std::vector<std::uint64_t> seeds;
  std::vector<std::string> left_out;  // an InputError with one of these keys leaves that pile out
  std::function<void(const std::string&)> note;  // is told of those, with their mistakes
};

// check: before a pile is settled; may throw. visit: with each pile that has settled. Throws Stopped on a signal.
void for_each_pile(const SeededPiles& piles, const std::function<void(const ResolvedMission&)>& check,
                   const std::function<void(const SeededPile&)>& visit);

}  // namespace rubble
