// From a settled pile and the robots of its mission to what simulators are given.
#pragma once

#include <string>
#include <vector>

#include "app/mission/resolved_mission.h"
#include "app/robots/mission_robot.h"
#include "io/scenes/sim_scene.h"
#include "kernel/model/pile_state.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

// Which pieces may move in a simulator; all others are fixed where they are.
struct DynamicChoice {
  enum class Kind { none, near, all } kind = Kind::none;
  Vec3 centre;            // unit: m
  double radius = 0;      // of pieces whose centre of mass is nearer; unit: m
  bool upright = false;   // distance from an upright line through the centre, at any height
};

// "all", "none", "near=X,Y,R" or "near=X,Y,Z,R". Throws InputError, with `key` as what was read.
DynamicChoice parse_dynamic(const std::string& text, const std::string& key);

struct BuiltScene {
  ExportModel model;
  std::vector<std::string> notes;  // what of the pile and the robots is left out for every simulator, a sentence each
};

// Whether any of these formats has a scene, not meshes alone; names of mesh_formats().
bool needs_scene(const std::vector<std::string>& formats);
// The pile as export_pile() wants it for formats of meshes; with pictures of the looks if any of the formats has those.
ExportModel build_mesh_model(const AssetLibrary& assets, const PileState& pile, const std::vector<std::string>& formats, int threads);

// robots: by make_robots(), each where the mission puts it. threads: the result does not depend on it. Refers to the mission's assets and to the pile. Throws
// InputError for a state of another pile.
BuiltScene build_sim_scene(const ResolvedMission& mission, const PileState& pile, const std::vector<MissionRobot>& robots,
                           const DynamicChoice& dynamic, int threads);

// The same notes with what the formats cannot say; formats: names of mesh_formats().
std::vector<std::string> list_notes(const BuiltScene& built, const std::vector<std::string>& formats);

// Robots and cameras of a mission for simulators.

// Each at the place and with the joints that the mission starts it with. notes: what of them is left out.
void add_robots(const Scenario& scenario, const std::vector<MissionRobot>& robots, SimScene& scene, std::vector<std::string>& notes);

// On the links that carry them, or where the flight begins. After add_robots().
void add_cameras(const Scenario& scenario, const std::vector<MissionRobot>& robots, SimScene& scene, std::vector<std::string>& notes);

}  // namespace rubble
