// What decides a dataset, complete: with a provenance and the packs' content, a run can be had
// again when its script is gone. Every manifest holds one, and so does every unfinished run.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scripting/mission.h"

namespace rubble {

struct AssetContent {
  std::string name, pack;  // of the asset, and of its pack
  std::string sha256;      // over the mesh and collision files and the physical properties
  // The pack's own, for missions without a mix: see Asset.
  double weight = 1;
  std::array<double, 2> scale{1, 1};  // least and most
  SizeDistribution spread{};          // between these two
};

// The file of a robot that is no bundled one.
struct RobotContent {
  std::string urdf;    // as the mission names it
  std::string sha256;  // over the URDF file and the meshes that it names
};

// The file that settling went on from.
struct SnapshotContent {
  std::string file;    // as pile.snapshot names it
  std::string sha256;  // of the file
};

enum class RunKind {
  run,     // a pile and its frames
  settle,  // the pile only
  render,  // frames of a pile that another run settled
};

struct Provenance {
  RunKind kind = RunKind::run;                  // which stages the run has
  SourceFile script;                            // path: its name alone
  std::vector<SourceFile> included;             // path: relative to the script's folder
  std::optional<std::uint64_t> seed;            // what was asked for besides the script
  std::vector<std::string> overrides;           // likewise: --set
  std::string scenario;                         // what followed from all this: JSON without spaces
  std::vector<AssetContent> assets;             // what is dropped, in the order of the pile's types
  std::vector<RobotContent> robots;             // of the robots with a URDF file, in the mission's order
  std::optional<SnapshotContent> snapshot;      // of a pile that settled from one
  std::shared_ptr<const Provenance> pile_from;  // of a `render`: of the run that settled the pile
};

// options: those that the mission was loaded with.
Provenance make_provenance(RunKind kind, const Mission& mission, const MissionOptions& options);

// Resolves the script again. Throws InputError when this program cannot.
Mission load_mission(const Provenance& provenance);

// The scenario that the provenance states, whatever the script would give today. Throws InputError.
Scenario stated_scenario(const Provenance& provenance);

// A mission over somebody else's pile: takes over what settled it. The rest stays as it is.
void adopt_pile(Scenario& scenario, const Scenario& pile_source);

// As members "kind", "script", "included", "request", "scenario", "assets", "robots" (where a URDF file is used), "snapshot"
// (where there is one) and "pile_from".
void add_provenance(nlohmann::ordered_json& json, const Provenance& provenance);
// Throws InputError naming `file` and the member that is missing or of another type.
Provenance provenance_from_json(const nlohmann::ordered_json& json, const std::string& file);

}  // namespace rubble
