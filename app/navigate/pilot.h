// What drives a robot: its own map, MRPT's navigator, and a global planner over that map where one is asked for. It
// knows nothing of where scans and poses come from: of the benchmark, or of ROS.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/navigate/navigation_rules.h"
#include "app/navigate/obstacle_map.h"
#include "app/navigate/route.h"
#include "io/mrpt/reactive_navigator.h"

namespace rubble {

struct PilotOptions {
  NavigationRules rules;
  Aabb bounds;                         // of the map; unit: m
  std::vector<NavigatorSlice> shape;   // of the robot
  std::vector<Vec3> waypoints;         // on the ground, one after the other; the last one is the goal
  std::uint64_t seed = 0;              // of the planner
  std::string cache_folder;            // as NavigatorOptions
};

// The robot at an instant.
struct PilotInput {
  double time = 0;         // since the start; unit: s
  Vec3 base;               // on its ground, in the frame of the map; unit: m
  double yaw = 0;          // unit: rad
  Vec3 velocity;           // in the frame of the map; unit: m/s
  double turn_rate = 0;    // unit: rad/s
};

class Pilot {
 public:
  // Throws as ReactiveNavigator does.
  explicit Pilot(const PilotOptions& options);

  // As ObstacleMap::add(); unit: m, in the frame of the map.
  void see(const Vec3& place) { map_.add(place); }
  // As ObstacleMap::add_scan().
  void see(const Vec3& sensor, const std::vector<Vec3>& echoes) { map_.add_scan(sensor, echoes); }
  // What to drive until the next call. Arrived: at the last waypoint.
  NavigatorOutput step(const PilotInput& input);

  const ObstacleMap& map() const { return map_; }
  const Vec3& target() const { return target_; }  // of the navigator
  int plans() const { return route_.plans(); }
  int plans_failed() const { return route_.failed(); }

 private:
  const Vec3& next() const { return waypoints_[waypoint_]; }
  bool is_last() const { return waypoint_ + 1 == waypoints_.size(); }
  void choose_waypoint(const Vec3& base);
  void drive_to(const Vec3& place);
  void follow_route(const PilotInput& input);
  bool is_stuck(const PilotInput& input);
  NavigatorInput make_input(const PilotInput& input) const;

  NavigationRules rules_;
  ObstacleMap map_;
  ReactiveNavigator navigator_;
  Route route_;
  std::vector<Vec3> waypoints_;
  std::size_t waypoint_ = 0;  // that it drives to
  Vec3 target_;               // of the navigator
  bool started_ = false;
  bool has_arrived_ = false;  // at the target
  Vec3 stuck_at_;             // where it was when it last got anywhere
  double stuck_since_ = 0, other_way_since_ = 0;  // unit: s
};

}  // namespace rubble
