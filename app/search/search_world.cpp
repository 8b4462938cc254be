#include "app/search/search_world.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/scene/build_scene.h"
#include "app/victims/place_victims.h"
#include "kernel/base/number_text.h"
#include "kernel/base/portable_math.h"
#include "kernel/voids/void_path.h"
#include "scripting/scenario/camera_scenario.h"

namespace rubble {
namespace {

constexpr double kBefore = 0.5;     // the entrance, where the robot starts if it has room; unit: m

VoidMap make_map(const ResolvedMission& mission, const PileState& pile, const SearchRules& rules, int threads) {
  VoidSpaceOptions options = victim_space_options(rules.radius);
  options.threads = threads;
  options.scenery = mission.assets.terrain();
  return find_voids(calc_void_space(pile, mission.assets.finest_meshes(), options), {rules.radius});
}

}  // namespace

Intrinsics search_camera(const SearchRules& rules) {
  CameraScenario camera;
  camera.width = rules.width, camera.height = rules.height, camera.fov_deg = rules.fov_deg;
  return camera.intrinsics();
}

Pose SearchPose::world_from_body() const {
  return {{portable::cos(0.5 * yaw), 0, 0, portable::sin(0.5 * yaw)}, position};
}

SearchWorld::SearchWorld(const ResolvedMission& mission, const PileState& pile, const SearchRules& rules, int threads)
    : rules_(rules), queries_(pile, mission.assets.finest_meshes()),
      world_(build_scene(mission.scenario, mission.assets, pile)), rays_(search_camera(rules), rules.max_range),
      pool_(threads), map_(make_map(mission, pile, rules, threads)), is_victim_(pile.pieces.size(), 0) {
  const std::vector<const TriangleMesh*> meshes = mission.assets.finest_meshes();
  for (const PieceState& piece : pile.pieces)
    if (piece.status != PieceStatus::lost && !mission.assets.types[std::size_t(piece.type)].surface)
      for (const Vec3f& p : meshes[std::size_t(piece.type)]->positions)
        bounds_.include(piece.world_from_body * (Vec3(p) * piece.scale));
  for (const Void& v : map_.robots.front().voids)
    if (!v.entrances.empty()) reachable_.insert(reachable_.end(), v.cells.begin(), v.cells.end());
  std::sort(reachable_.begin(), reachable_.end());
  find_start();
  find_targets(pile);
}

bool SearchWorld::is_free(const Vec3& place) const {
  return queries_.clearance(place, 2 * rules_.radius) >= rules_.radius;
}

void SearchWorld::look(const Pose& world_from_camera, std::vector<float>& depth,
                       std::vector<std::int32_t>& pieces) const {
  rays_.cast(world_, world_from_camera, pool_, depth.data(), pieces.data());
}

// Before the widest entrance of the largest void, facing it.
void SearchWorld::find_start() {
  const auto& voids = map_.robots.front().voids;
  const auto largest = std::find_if(voids.begin(), voids.end(), [](const Void& v) { return !v.entrances.empty(); });
  if (largest == voids.end())
    throw InputError({"", 0, "pile", "no void for the robot", "one that a ball of " + plain_text(rules_.radius) +
                      " m can enter", std::to_string(voids.size()) + " that are sealed", "another pile or seed"});
  const Entrance& entrance = largest->entrances.front();
  start_.position = entrance.position;
  start_.yaw = portable::atan2(entrance.inward.y, entrance.inward.x);
  const VoidSpace& space = map_.space;
  for (double d = 0.05; d <= kBefore; d += 0.05) {
    // Middles of cells, from where ways over cells begin.
    const Cell cell = space.grid.find_cell(entrance.position - entrance.inward * d);
    if (!space.grid.contains(cell) || space.clearance[space.grid.index(cell)] < rules_.radius) return;
    if (is_free(space.grid.centre(cell))) start_.position = space.grid.centre(cell);
  }
}

// Of each victim the place in reach from which the way from the start is shortest.
void SearchWorld::find_targets(const PileState& pile) {
  const std::vector<float> ways = calc_ways_through(map_.space, start_.position, rules_.radius);
  for (const Victim& victim : find_victims(pile)) {
    is_victim_[std::size_t(victim.piece)] = 1;
    SearchTarget target{victim, {}, std::numeric_limits<double>::infinity()};
    for (std::size_t i = 0; i < ways.size(); ++i) {
      const Vec3 place = map_.space.grid.centre(i);
      if (double(ways[i]) >= target.shortest || !sees_victim(queries_, place, victim)) continue;
      target.shortest = double(ways[i]), target.lookout = place;
    }
    targets_.push_back(target);
  }
  if (targets_.empty())
    throw InputError({"", 0, "victims.count", "there are no victims", "1 or more", "0",
                      "victims = { count = 4 } in the mission, or --set victims.count=4"});
}

}  // namespace rubble
