#include "bench/equilibrium/work.h"

#include <algorithm>
#include <filesystem>

#include "app/mission/finished_run.h"
#include "app/scene/build_scene.h"
#include "bench/workload_file.h"
#include "kernel/base/error.h"
#include "kernel/settling/generator.h"
#include "scripting/mission.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;

struct NamedWork {
  const char* name;
  const char* group;
  const char* file;  // relative to the sources; a workload's is written by the build
  const char* text;
};

constexpr NamedWork kWorks[] = {
    {"w1", "standard", "w1.txt", "1,200 pieces of convex concrete"},
    {"w2", "standard", "w2.txt", "3,750 of them"},
    {"demo", "standard", "scripts/first_pile.lua", "the pile of make demo"},
    {"concrete", "packs", "bench/equilibrium/concrete.lua", "4 x 120 of the pack"},
    {"residential", "packs", "bench/equilibrium/residential.lua", "likewise"},
    {"parking", "packs", "bench/equilibrium/parking.lua", "4 x 60 of the pack"},
    {"bridge", "packs", "bench/equilibrium/bridge.lua", "4 x 120 of the pack"},
    {"mixed", "packs", "bench/equilibrium/mixed.lua", "likewise, of all four packs"},
    {"articulated", "packs", "bench/equilibrium/articulated.lua",
     "5 x 150 of concrete and residential, with hinged slabs"},
    {"terrain", "packs", "scripts/terrain.lua", "a hillside"},
    {"tall", "large", "bench/equilibrium/tall.lua", "40 x 75 of concrete and residential"},
    {"bars", "odd", "bench/equilibrium/odd/bars.lua", "nothing but reinforcement bars"},
    {"sheets", "odd", "bench/equilibrium/odd/sheets.lua", "nothing but thin sheets"},
    {"bricks", "odd", "bench/equilibrium/odd/bricks.lua", "one kind of brick"},
    {"masses", "odd", "bench/equilibrium/odd/masses.lua", "masses of 1 to 10,000"},
    {"gravel", "odd", "bench/equilibrium/odd/gravel.lua", "gravel of 3 cm"},
    {"concave", "odd", "bench/equilibrium/odd/concave.lua", "pieces that hook into each other"},
    {"slabs", "odd", "bench/equilibrium/odd/slabs.lua", "flat slabs"},
    {"furniture", "odd", "bench/equilibrium/odd/furniture.lua", "furniture and cars"},
    {"steel", "odd", "bench/equilibrium/odd/steel.lua", "girders, rails and mats"},
    {"a_frame", "collapse", "scripts/collapse/a_frame.lua", "a collapse mode"},
    {"cantilever", "collapse", "scripts/collapse/cantilever.lua", "likewise"},
    {"culvert", "collapse", "scripts/collapse/culvert.lua", "likewise"},
    {"curtain", "collapse", "scripts/collapse/curtain.lua", "likewise"},
    {"free", "collapse", "scripts/collapse/free.lua", "likewise"},
    {"heap", "collapse", "scripts/collapse/heap.lua", "likewise"},
    {"inclined", "collapse", "scripts/collapse/inclined.lua", "likewise"},
    {"lean_over", "collapse", "scripts/collapse/lean_over.lua", "likewise"},
    {"lean_to", "collapse", "scripts/collapse/lean_to.lua", "likewise"},
    {"pancake", "collapse", "scripts/collapse/pancake.lua", "likewise"},
    {"v_shape", "collapse", "scripts/collapse/v_shape.lua", "likewise"},
    {"blast", "ruins", "scripts/ruins/blast.lua", "a building that comes down"},
    {"brick_house", "ruins", "scripts/ruins/brick_house.lua", "likewise"},
    {"bridge_span", "ruins", "scripts/ruins/bridge_span.lua", "likewise"},
    {"car_park", "ruins", "scripts/ruins/car_park.lua", "likewise"},
    {"corner_bay", "ruins", "scripts/ruins/corner_bay.lua", "likewise"},
    {"half_removed", "ruins", "scripts/ruins/half_removed.lua", "likewise"},
    {"loaded_floor", "ruins", "scripts/ruins/loaded_floor.lua", "likewise"},
    {"loaded_roof", "ruins", "scripts/ruins/loaded_roof.lua", "likewise"},
    {"lorry", "ruins", "scripts/ruins/lorry.lua", "likewise"},
    {"planned_house", "ruins", "scripts/ruins/planned_house.lua", "likewise"},
    {"precast_deck", "ruins", "scripts/ruins/precast_deck.lua", "likewise"},
    {"quake", "ruins", "scripts/ruins/quake.lua", "likewise"},
    {"quake_frame", "ruins", "scripts/ruins/quake_frame.lua", "likewise"},
    {"row_of_columns", "ruins", "scripts/ruins/row_of_columns.lua", "likewise"},
    {"sinking", "ruins", "scripts/ruins/sinking.lua", "likewise"},
    {"soft_ground", "ruins", "scripts/ruins/soft_ground.lua", "likewise"},
    {"stair_shaft", "ruins", "scripts/ruins/stair_shaft.lua", "likewise"},
};

bool is_mission_path(const std::string& name) { return fs::path(name).extension() == ".lua"; }
bool is_workload(const std::string& file) { return fs::path(file).extension() == ".txt"; }

// Of a named work, or the path itself.
std::string find_file(const std::string& name) {
  for (const NamedWork& work : kWorks) {
    if (name != work.name) continue;
    if (is_workload(work.file))
      return fs::read_symlink("/proc/self/exe").parent_path() / work.file;
    return std::string(RUBBLE_SOURCE_DIR "/") + work.file;
  }
  return name;
}

Work load_workload_work(const std::string& file, std::uint64_t seed) {
  Work work;
  work.pile = load_workload(file);
  if (seed != 0) turn_pieces(work.pile, seed);
  return work;
}

Work load_mission_work(const std::string& file, std::uint64_t seed,
                       const std::vector<std::string>& overrides) {
  MissionOptions options;
  options.seed = seed;
  options.overrides = overrides;
  const Mission mission = load_mission(file, options);
  const AssetLibrary assets = load_assets(mission, {});
  Work work;
  work.settle = mission.scenario.settle;
  work.pile = generate_pile(build_pile_spec(mission.scenario.pile, mission.scenario.seed, assets));
  return work;
}

}  // namespace

std::vector<std::string> expand_work_names(const std::vector<std::string>& names) {
  std::vector<std::string> expanded;
  for (const std::string& name : names) {
    const std::size_t before = expanded.size();
    for (const NamedWork& work : kWorks) {
      if (name == work.name || name == work.group || name == "all") expanded.push_back(work.name);
    }
    if (is_mission_path(name) || is_workload(name)) expanded.push_back(name);
    if (expanded.size() == before)
      throw InputError({"", 0, "--work", "unknown work",
                        "a mission (.lua), a workload (.txt) or one of:\n" + describe_work_names(),
                        "\"" + name + "\"", ""});
  }
  return expanded;
}

std::string describe_work_names() {
  std::string text, group;
  for (const NamedWork& work : kWorks) {
    if (group != work.group) text += "  " + std::string(work.group) + ":\n";
    group = work.group;
    text += "    " + std::string(work.name) + ": " + work.text + "\n";
  }
  return text + "  all: all of these\n";
}

Work load_work(const std::string& name, std::uint64_t seed,
               const std::vector<std::string>& overrides) {
  const std::string file = find_file(name);
  if (is_workload(file) && !overrides.empty())
    throw InputError(
        {"", 0, "--set", "a workload file has no keys", "a mission", "\"" + name + "\"", ""});
  Work work = is_workload(file) ? load_workload_work(file, seed)
                                : load_mission_work(file, seed, overrides);
  work.name = name;
  work.seed = seed;
  return work;
}

SavedPile load_saved_pile(const std::string& folder) {
  const FinishedRun run = open_finished_run(folder);
  const AssetLibrary assets = load_assets_of(run, {});
  const Provenance& provenance = run.manifest.provenance;
  const Scenario scenario =
      stated_scenario(provenance.pile_from ? *provenance.pile_from : provenance);
  SavedPile saved;
  saved.work.name = folder;
  saved.work.seed = run.manifest.seed;
  saved.work.settle = scenario.settle;
  saved.work.pile = generate_pile(build_pile_spec(scenario.pile, scenario.seed, assets));
  saved.state = load_pile_of(run);
  return saved;
}

}  // namespace rubble
