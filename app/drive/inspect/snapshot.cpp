#include "app/drive/inspect/snapshot.h"

#include <algorithm>

#include "app/mission/scenario_lua.h"
#include "io/base/atomic_file.h"
#include "io/state/checkpoint_file.h"

namespace rubble {

std::string save_snapshot(const ResolvedMission& mission, const SettleCheckpoint& moment, const std::string& folder,
                          const std::string& name, const std::string& comment, bool packs) {
  const std::string state = folder + "/" + name + ".state", script = folder + "/" + name + ".lua";
  save_checkpoint(moment, state);
  Scenario scenario = with_whole_paths(mission.scenario, mission.assets, packs);
  if (std::any_of(scenario.robots.begin(), scenario.robots.end(), [](const RobotItem& robot) { return robot.control != 0; }))
    return state;
  scenario.pile.snapshot = name + ".state";
  write_text_file(script, scenario_to_lua(scenario, comment));
  return script;
}

}  // namespace rubble
