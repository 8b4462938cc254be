// The way that a global planner finds over the robot's own map, kept until something is seen in it; the navigator is given
// places on it to drive to.
#pragma once

#include <cstdint>
#include <vector>

#include "app/navigate/navigation_rules.h"
#include "app/navigate/obstacle_map.h"
#include "io/ompl/plane_planner.h"
#include "kernel/base/parallel.h"

namespace rubble {

class Route {
 public:
  Route(const NavigationRules& rules, std::uint64_t seed) : rules_(rules), seed_(seed), pool_(1) {}

  // Where to drive to now from `base`: a place on the way to `goal`, as far ahead as it can be driven to straight; the goal
  // itself where it is near, or where no way is known. time: since the start; unit: s.
  Vec3 find_target(const ObstacleMap& map, const Vec3& base, const Vec3& goal, double time);

  // The robot does not get on: the narrowest place just ahead on the way is not planned through again.
  void avoid_narrowest_ahead(const ObstacleMap& map, const Vec3& base);

  int plans() const { return plans_; }    // that were made
  int failed() const { return failed_; }  // of these, that found no way

 private:
  PlaneClearance measure(const ObstacleMap& map, const Vec3& base);
  void close(const Vec3& place, PlaneClearance& plane) const;
  bool is_blocked(const PlaneClearance& clearance) const;
  void plan(const PlaneClearance& clearance, const Vec3& base, double time);
  void go_on_to(const Vec3& base);

  NavigationRules rules_;
  std::uint64_t seed_;
  ThreadPool pool_;
  Vec3 goal_;
  std::vector<Vec3> way_;  // places kSpacing apart, from where it was planned to the goal; empty: none
  std::size_t at_ = 0;     // of these, the nearest to the robot
  std::vector<Vec3> avoided_;
  double planned_ = -1e9;  // when the last plan was made; unit: s
  int plans_ = 0, failed_ = 0;
};

}  // namespace rubble
