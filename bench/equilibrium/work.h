// The work list of the equilibrium bench: what falls, by name and seed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernel/model/pile.h"
#include "kernel/model/pile_state.h"
#include "kernel/settling/settle.h"

namespace rubble {

struct Work {
  std::string name;
  std::uint64_t seed = 0;
  Pile pile;
  SettleOptions settle;  // the mission's; those of a workload file are the defaults
};

// Groups such as "packs", "collapse" or "all" become their members; other names stay as they are.
// Throws InputError for a name that is neither known nor the path of a mission.
std::vector<std::string> expand_work_names(const std::vector<std::string>& names);

// Every name with a few words of what it is, for --help.
std::string describe_work_names();

// A workload file with its orientations drawn from `seed` (0: as written), or a mission with that
// seed. overrides: "key=value", of missions only. Throws InputError.
Work load_work(const std::string& name, std::uint64_t seed,
               const std::vector<std::string>& overrides = {});

// A settled pile from the folder of a finished run (pile.bin), and what it was settled from.
struct SavedPile {
  Work work;
  PileState state;
};
SavedPile load_saved_pile(const std::string& folder);

}  // namespace rubble
