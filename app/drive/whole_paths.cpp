#include "app/drive/whole_paths.h"

#include <filesystem>

namespace rubble {
namespace {

namespace fs = std::filesystem;

std::string whole(const fs::path& path) { return fs::absolute(path).lexically_normal().string(); }

}  // namespace

Scenario with_whole_paths(Scenario scenario, const AssetLibrary& assets, bool packs) {
  std::error_code failed;
  if (packs || !scenario.packs.empty()) {
    scenario.packs.clear();
    // The folders of other files are among them.
    for (const std::string& folder : assets.folders)
      if (fs::is_regular_file(fs::path(folder) / "pack.lua", failed)) scenario.packs.push_back(whole(folder));
  }
  std::string& terrain = scenario.pile.terrain.file;
  for (const std::string& folder : assets.folders)
    if (!terrain.empty() && fs::is_regular_file(fs::path(folder) / terrain, failed)) terrain = whole(fs::path(folder) / terrain);
  if (scenario.pile.snapshot) scenario.pile.snapshot = whole(assets.snapshot_file);
  for (std::size_t i = 0; i < scenario.robots.size(); ++i)
    if (!scenario.robots[i].urdf.empty()) scenario.robots[i].urdf = whole(assets.robot_files.at(i));
  return scenario;
}

}  // namespace rubble
