// A settled pile as the navigation benchmark sees it: where the crawler starts, through which void it shall drive,
// and where to.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/mission/resolved_mission.h"
#include "app/navigate/navigation_rules.h"
#include "kernel/model/pile.h"
#include "kernel/model/pile_state.h"
#include "kernel/queries/queries.h"
#include "kernel/voids/void_map.h"
#include "render/lidar/lidar.h"
#include "render/rays/ray_world.h"
#include "scripting/sensors/sensor_item.h"

namespace rubble {

class NavigationWorld {
 public:
  // Throws InputError with the key `pile`: no void with an entrance on the ground that is wide enough, no room for the
  // robot before it. The mission and the pile must outlive it.
  NavigationWorld(const ResolvedMission& mission, const PileState& pile, const NavigationRules& rules, int threads);

  const NavigationRules& rules() const { return rules_; }
  const ResolvedMission& mission() const { return mission_; }
  const PileState& pile() const { return pile_; }
  const std::shared_ptr<RayWorld>& ray_world() const { return ray_world_; }
  int threads() const { return threads_; }

  const Pose& start() const { return start_; }  // of the robot's base: on the ground, facing an entrance
  // On the ground: the void's entrance, where the goal is outside again also the other one, and the goal.
  const std::vector<Vec3>& waypoints() const { return waypoints_; }
  const Vec3& goal() const { return waypoints_.back(); }
  bool passes() const { return passes_; }       // the goal is outside again, else inside
  // Of the ball through the void, from start to goal: the shortest way; unit: m.
  double shortest() const { return shortest_; }
  const Aabb& bounds() const { return bounds_; }  // of all that the robot may see; unit: m
  // Whether a robot whose base is there is in the void.
  bool is_inside(const Vec3& base) const;
  // Whether a place is inside of a piece, or below the ground.
  bool is_solid(const Vec3& place) const;

 private:
  struct Door;
  void choose_void();
  bool try_void(const Void& v);
  std::vector<Door> find_doors(const Void& v) const;
  std::optional<Vec3> find_low_place(const Vec3& beside) const;
  std::optional<Vec3> find_room(const Vec3& entrance, const Vec3& out) const;
  bool has_room(const Vec3& place, const Vec3& ahead) const;

  NavigationRules rules_;
  const ResolvedMission& mission_;
  const PileState& pile_;
  int threads_;
  std::shared_ptr<RayWorld> ray_world_;
  PileQueries queries_;
  VoidMap map_;
  Aabb bounds_;
  Pose start_;
  std::vector<Vec3> waypoints_;
  bool passes_ = false;
  double shortest_ = 0;
  std::vector<std::uint32_t> inside_;  // cells of the void, ascending
};

// The scanner of the navigation benchmark: a LiDAR of 32 rings that scans once a period.
using RangeScanner = Lidar;

// As a mission has it.
SensorItem make_range_scanner(const NavigationRules& rules, const std::string& name);

// On the robot of the benchmark. world_from_base: at that time since its first scan began; unit: s
RangeScanner make_range_scanner(const NavigationWorld& world, std::uint64_t seed, std::function<Pose(double time)> world_from_base);

}  // namespace rubble
