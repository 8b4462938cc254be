#include "app/navigate/route.h"

#include <algorithm>
#include <cmath>

#include "kernel/geometry/distance_transform.h"

namespace rubble {
namespace {

constexpr double kSpacing = 0.1;  // of places on a way; unit: m
constexpr double kSpare = 0.05;   // what is seen nearer than the radius less this blocks a way; unit: m
constexpr double kRetry = 1;      // after a plan that found no way; unit: s
constexpr double kNear = 1, kFar = 2;  // how far ahead the place to drive to is; unit: m
constexpr double kStuckReach = 1.2;      // ahead, what it is stuck at is looked for; unit: m
constexpr std::size_t kAhead = 20;       // places on the way among which the nearest is looked for

Vec3 flat(const Vec3& p) { return {p.x, p.y, 0}; }

std::vector<Vec3> cut_up(const std::vector<Vec3>& corners) {
  std::vector<Vec3> places;
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    const int parts = std::max(1, int(std::ceil(distance(corners[i], corners[i + 1]) / kSpacing)));
    for (int k = 0; k < parts; ++k) places.push_back(corners[i] + (corners[i + 1] - corners[i]) * (double(k) / parts));
  }
  if (!corners.empty()) places.push_back(corners.back());
  return places;
}

}  // namespace

PlaneClearance Route::measure(const ObstacleMap& map, const Vec3& base) {
  PlaneClearance plane{map.flat_grid(), {}};
  const std::vector<Cell> solid = map.find_columns(base.z + rules_.step_height, base.z + rules_.height);
  const std::vector<std::uint32_t> nearest = find_nearest_seeds(plane.grid, solid, pool_);
  plane.clearance.resize(nearest.size());
  for (std::size_t i = 0; i < nearest.size(); ++i)
    plane.clearance[i] = nearest[i] == kNoSeed
                             ? 1e6f
                             : float(distance(plane.grid.centre(i), plane.grid.centre(solid[nearest[i]])));
  for (const Vec3& place : avoided_) close(place, plane);
  return plane;
}

// No disc has room whose middle is there.
void Route::close(const Vec3& place, PlaneClearance& plane) const {
  for (std::size_t i = 0; i < plane.clearance.size(); ++i) {
    const double d = distance(flat(plane.grid.centre(i)), place);
    plane.clearance[i] = std::min(plane.clearance[i], float(d));
  }
}

void Route::avoid_narrowest_ahead(const ObstacleMap& map, const Vec3& base) {
  if (way_.empty()) return;
  const PlaneClearance clearance = measure(map, base);
  const std::size_t last = std::min(at_ + std::size_t(kStuckReach / kSpacing), way_.size() - 1);
  std::size_t narrowest = last;
  for (std::size_t i = at_; i < last; ++i)
    if (distance(way_[i], flat(base)) > rules_.plan_radius && clearance.at(way_[i]) < clearance.at(way_[narrowest])) narrowest = i;
  avoided_.push_back(way_[narrowest]);
  way_.clear(), planned_ = -1e9;
}

Vec3 Route::find_target(const ObstacleMap& map, const Vec3& base, const Vec3& goal, double time) {
  const bool other_goal = distance(goal, goal_) > 0;
  goal_ = goal;
  const PlaneClearance clearance = measure(map, base);
  if (!way_.empty()) go_on_to(base);
  const bool again = way_.empty() ? time - planned_ > kRetry : is_blocked(clearance);
  if (other_goal || again) plan(clearance, base, time);
  if (way_.empty()) return goal;
  std::size_t place = std::min(at_ + std::size_t(kFar / kSpacing), way_.size() - 1);
  const std::size_t least = std::min(at_ + std::size_t(kNear / kSpacing), way_.size() - 1);
  while (place > least && !is_leg_free(clearance, flat(base), way_[place], rules_.plan_radius - kSpare)) --place;
  return place + 1 == way_.size() ? goal : way_[place];
}

void Route::go_on_to(const Vec3& base) {
  const std::size_t last = std::min(at_ + kAhead, way_.size() - 1);
  std::size_t nearest = at_;
  for (std::size_t i = at_; i <= last; ++i)
    if (distance(way_[i], flat(base)) < distance(way_[nearest], flat(base))) nearest = i;
  at_ = nearest;
}

// The first and last places may be near something: the robot was there, or was told to go there.
bool Route::is_blocked(const PlaneClearance& clearance) const {
  for (std::size_t i = at_; i < way_.size(); ++i) {
    const bool at_end = distance(way_[i], way_[at_]) < rules_.plan_radius || distance(way_[i], way_.back()) < rules_.plan_radius;
    if (!at_end && clearance.at(way_[i]) < rules_.plan_radius - kSpare) return true;
  }
  return false;
}

void Route::plan(const PlaneClearance& clearance, const Vec3& base, double time) {
  PlanePlannerOptions options;
  options.radius = rules_.plan_radius;
  options.seed = seed_ + std::uint64_t(plans_);
  way_ = cut_up(plan_in_plane(clearance, flat(base), flat(goal_), options));
  at_ = 0, planned_ = time;
  ++plans_, failed_ += way_.empty();
}

}  // namespace rubble
