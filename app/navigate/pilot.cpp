#include "app/navigate/pilot.h"

#include <cmath>

#include "kernel/base/portable_math.h"

namespace rubble {
namespace {

constexpr double kOtherTarget = 0.25;  // a target that is nearer to the one before is not another one; unit: m

NavigatorOptions make_navigator_options(const PilotOptions& pilot) {
  NavigatorOptions options;
  options.slices = pilot.shape;
  options.max_speed = pilot.rules.speed, options.max_turn_rate = pilot.rules.turn_rate;
  options.horizon = pilot.rules.horizon, options.goal_radius = pilot.rules.goal_radius;
  options.cache_folder = pilot.cache_folder;
  return options;
}

}  // namespace

Pilot::Pilot(const PilotOptions& options)
    : rules_(options.rules), map_(options.bounds, rules_.voxel, rules_.hits), navigator_(make_navigator_options(options)),
      route_(rules_, options.seed), waypoints_(options.waypoints) {
  drive_to(next());
}

NavigatorOutput Pilot::step(const PilotInput& input) {
  if (!started_) stuck_at_ = input.base;
  started_ = true;
  choose_waypoint(input.base);
  if (rules_.plans) follow_route(input);
  NavigatorOutput output = navigator_.step(make_input(input));
  has_arrived_ = output.state == NavigatorState::arrived;
  if (has_arrived_ && is_last() && distance(target_, next()) == 0) return output;
  // At a place of the route it goes on with the next call.
  if (has_arrived_) output.state = NavigatorState::driving;
  if (is_stuck(input)) output.state = NavigatorState::gave_up;
  return output;
}

// Goes on to the next one before the robot stops at this one.
void Pilot::choose_waypoint(const Vec3& base) {
  const Vec3 d = next() - base;
  if (is_last() || std::sqrt(d.x * d.x + d.y * d.y) > rules_.waypoint_radius) return;
  ++waypoint_;
  drive_to(next());
}

void Pilot::drive_to(const Vec3& place) {
  target_ = place;
  navigator_.set_goal(place.x, place.y);
}

// The navigator begins anew with each goal: it is given another one only where that is elsewhere.
void Pilot::follow_route(const PilotInput& input) {
  const Vec3 target = route_.find_target(map_, input.base, next(), input.time);
  const double moved = distance(target, target_);
  if (moved > kOtherTarget || (moved > 0 && (has_arrived_ || distance(target, next()) == 0))) drive_to(target);
}

// As long as the navigator gets new goals it does not tell.
bool Pilot::is_stuck(const PilotInput& input) {
  if (!rules_.plans) return false;
  if (distance(input.base, stuck_at_) > rules_.stuck_distance)
    stuck_at_ = input.base, stuck_since_ = other_way_since_ = input.time;
  if (input.time - other_way_since_ > rules_.other_way_after) {
    route_.avoid_narrowest_ahead(map_, input.base);
    other_way_since_ = input.time;
  }
  return input.time - stuck_since_ > rules_.stuck_time;
}

NavigatorInput Pilot::make_input(const PilotInput& robot) const {
  NavigatorInput input;
  input.time = robot.time;
  input.x = robot.base.x, input.y = robot.base.y, input.yaw = robot.yaw;
  input.velocity_x = robot.velocity.x, input.velocity_y = robot.velocity.y, input.turn_rate = robot.turn_rate;
  const double c = portable::cos(robot.yaw), s = portable::sin(robot.yaw);
  // The ground under the robot is not the plane z = 0 where it climbs.
  const double ground = robot.base.z;
  for (const Vec3& p : map_.find_around(robot.base, rules_.horizon, ground + rules_.step_height, ground + rules_.height)) {
    const Vec3 d = p - robot.base;
    input.obstacles.push_back({float(c * d.x + s * d.y), float(c * d.y - s * d.x), float(d.z)});
  }
  return input;
}

}  // namespace rubble
