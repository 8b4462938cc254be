#include "app/pipeline/seeded_piles.h"

#include <algorithm>

#include "app/control/robot_control.h"
#include "app/pipeline/stages.h"
#include "app/support/stop.h"

namespace rubble {

void for_each_pile(const SeededPiles& piles, const std::function<void(const ResolvedMission&)>& check,
                   const std::function<void(const SeededPile&)>& visit) {
  for (const std::uint64_t seed : piles.seeds) {
    RunRequest of = piles.of;
    of.seed = seed, of.options.quiet = true;
    RunContext context(of.options);
    const ResolvedMission mission = resolve_mission(of, RunKind::settle, context);
    check_robot_models(mission.scenario, mission.assets, mission.provenance.script);
    check(mission);
    try {
      const SettledPile pile = settle_in_memory(mission, context, [] { return !stop_requested(); });
      visit({seed, mission, pile.state, context.threads()});
    } catch (const InputError& error) {
      const std::string& key = error.diagnostics().front().key;
      if (std::find(piles.left_out.begin(), piles.left_out.end(), key) == piles.left_out.end()) throw;
      piles.note("seed " + std::to_string(seed) + " is left out: " + error.what());
    }
  }
}

}  // namespace rubble
