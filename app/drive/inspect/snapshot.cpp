#include "app/drive/inspect/snapshot.h"

#include <algorithm>
#include <filesystem>

#include "app/mission/scenario_lua.h"
#include "io/base/atomic_file.h"
#include "io/state/checkpoint_file.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;

// The script lies elsewhere than the mission: files that it names get their whole paths.
Scenario with_whole_paths(const ResolvedMission& mission) {
  Scenario scenario = mission.scenario;
  if (!scenario.packs.empty()) scenario.packs = mission.assets.folders;
  std::error_code failed;
  std::string& terrain = scenario.pile.terrain.file;
  for (const std::string& folder : mission.assets.folders)
    if (!terrain.empty() && fs::is_regular_file(fs::path(folder) / terrain, failed))
      terrain = fs::absolute(fs::path(folder) / terrain).lexically_normal().string();
  for (std::size_t i = 0; i < scenario.robots.size(); ++i)
    if (!scenario.robots[i].urdf.empty()) scenario.robots[i].urdf = mission.assets.robot_files.at(i);
  return scenario;
}

}  // namespace

std::string save_snapshot(const ResolvedMission& mission, const SettleCheckpoint& moment, const std::string& folder,
                          const std::string& name, const std::string& comment) {
  const std::string state = folder + "/" + name + ".state", script = folder + "/" + name + ".lua";
  save_checkpoint(moment, state);
  Scenario scenario = with_whole_paths(mission);
  if (std::any_of(scenario.robots.begin(), scenario.robots.end(), [](const RobotItem& robot) { return robot.control != 0; }))
    return state;
  scenario.pile.snapshot = name + ".state";
  write_text_file(script, scenario_to_lua(scenario, comment));
  return script;
}

}  // namespace rubble
