#include "app/navigate/navigation_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "app/control/robot_control.h"
#include "app/navigate/collision_counter.h"
#include "app/navigate/mission_to_drive.h"
#include "app/navigate/navigation_world.h"
#include "app/navigate/pilot.h"
#include "app/session/session.h"
#include "kernel/base/portable_math.h"
#include "kernel/robot/drive_commands.h"
#include "kernel/robot/robot_run.h"
#include "kernel/world/world_robots.h"

namespace rubble {
namespace {

// The crawler with its flippers half up, so that they climb what is low: body and tracks, and above them the flippers.
constexpr double kFlippers = 0.7;  // unit: rad
const std::vector<NavigatorSlice> kShape{{0.2, 0.46, 0.33}, {0.3, 0.57, 0.33}};
// Tracks that turn on the spot slide: the robot turns by this share of what its belts would give (docs/reference/robots.md).
constexpr double kTurnShare = 0.4;
constexpr double kFallen = 0.3;  // what of the base's Z axis is upright when it lies on its side

PilotOptions make_pilot_options(const NavigationWorld& world, std::uint64_t seed, const std::string& cache_folder) {
  PilotOptions options;
  options.rules = world.rules(), options.bounds = world.bounds(), options.shape = kShape;
  options.waypoints = world.waypoints(), options.seed = seed, options.cache_folder = cache_folder;
  return options;
}

// Before the void with its LiDAR, as make_mission_to_drive() has it, in debris that stays: scans are of the pile as it settled.
ResolvedMission make_mission(const NavigationWorld& world) {
  ResolvedMission mission = world.mission();
  mission.scenario = make_mission_to_drive(world);
  Scenario& scenario = mission.scenario;
  for (const char* flipper : {"front_left", "front_right", "rear_left", "rear_right"})
    scenario.robots.front().start.push_back({std::string(flipper) + "_flipper_joint", kFlippers});
  scenario.robot_run.duration = world.rules().time_limit;
  scenario.robot_run.control_hz = 1 / world.rules().period;
  scenario.robot_run.debris = DebrisMotion::fixed;
  scenario.sensors.clear();  // it has one of its own, that does not see the robot
  scenario.trajectory.ride.position = {};
  return mission;
}

RunOptions run_options(const NavigationWorld& world) {
  RunOptions options;
  options.threads = world.threads(), options.quiet = true;
  return options;
}

double yaw_of(const Pose& pose) {
  const Vec3 ahead = pose.rotation.rotate({1, 0, 0});
  return portable::atan2(ahead.y, ahead.x);
}

// The mission while it goes on.
class Drive {
 public:
  Drive(const NavigationWorld& world, std::uint64_t seed, const std::string& cache_folder)
      : world_(world), rules_(world.rules()), mission_(make_mission(world)), context_(run_options(world)),
        session_(mission_, world.pile(), make_robots(mission_, context_), context_, recorded()),
        scanner_(make_range_scanner(world, seed, [this](double time) { return base_at(time); })),
        pilot_(make_pilot_options(world, seed, cache_folder)),
        collisions_(int(world.pile().pieces.size()), rules_.step_height,
                    [&world](const Vec3& place) { return world.is_solid(place); }),
        last_(world.start().translation) {
    score_.passes = world.passes(), score_.shortest = world.shortest();
    session_.set_controller(0, [this](const RobotSense& sense) { return control(sense); });
  }

  NavigationScore go() {
    session_.start();
    do session_.step();
    while (note_step() && session_.steps() < session_.steps_of_mission());
    const DrivenRobots driven = session_.finish();
    score_.time = double(session_.steps()) * session_.step_time();
    score_.path = driven.summaries.front().path;
    score_.left = distance_to_goal();
    score_.collisions = collisions_.count();
    score_.plans = pilot_.plans(), score_.plans_failed = pilot_.plans_failed();
    score_.hash = driven.moved.track.hash();
    return score_;
  }

 private:
  static SessionOptions recorded() {
    SessionOptions options;
    options.recorded = true;
    return options;
  }

  // Scan k ends when period k begins; the first is of the robot before it starts.
  Pose base_at(double time) const {
    return session_.steps() == 0 ? session_.world_from_rig() : session_.ways().ride->at(time - rules_.period);
  }

  RobotCommand control(const RobotSense& sense) {
    const RangeScan scan = scanner_.take(score_.periods++);
    const auto before = std::chrono::steady_clock::now();
    map(scan);
    const Vec3 base = sense.state.links.front().world_from_link.translation;
    const NavigatorOutput output = pilot_.step(make_input(sense));
    const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
    score_.late += took > rules_.period;
    score_.slowest = std::max(score_.slowest, took);
    collisions_.begin_period();
    if (output.state == NavigatorState::gave_up) end_ = NavigationEnd::gave_up;
    if (output.state == NavigatorState::arrived) end_ = NavigationEnd::arrived;
    score_.way.push_back({base, yaw_of(sense.state.links.front().world_from_link), pilot_.target()});
    return drive_sides(session_.robots().front().model, output.linear, output.angular / kTurnShare, std::vector<double>(4, kFlippers));
  }

  double time() const { return (score_.periods - 1) * rules_.period; }

  void map(const RangeScan& scan) {
    for (const ScanPoint& p : scan.points) pilot_.see(scan.place(p));
  }

  PilotInput make_input(const RobotSense& sense) const {
    const RobotState::Link& base = sense.state.links.front();
    return {time(), base.world_from_link.translation, yaw_of(base.world_from_link), base.linear, base.angular.z};
  }

  // Whether it goes on.
  bool note_step() {
    const World& world = session_.world();
    const RobotState state = world.robots().state(0);
    if (state.lost) end_ = NavigationEnd::lost;
    const Pose& base = state.links.front().world_from_link;
    if (world_.is_inside(base.translation)) score_.inside += distance(base.translation, last_);
    last_ = base.translation;
    if (base.rotation.rotate({0, 0, 1}).z < kFallen) end_ = NavigationEnd::fell;
    collisions_.note(world.robots().contacts(0), base.translation);
    if (end_ != NavigationEnd::time_up) score_.end = end_;
    return end_ == NavigationEnd::time_up;
  }

  double distance_to_goal() const {
    const Vec3 d = last_ - world_.goal();
    return std::sqrt(d.x * d.x + d.y * d.y);
  }

  const NavigationWorld& world_;
  NavigationRules rules_;
  ResolvedMission mission_;
  RunContext context_;
  Session session_;
  RangeScanner scanner_;
  Pilot pilot_;
  CollisionCounter collisions_;
  NavigationScore score_;
  Vec3 last_;  // where its base was
  NavigationEnd end_ = NavigationEnd::time_up;  // until something ends it
};

}  // namespace

std::string name_of(NavigationEnd end) {
  switch (end) {
    case NavigationEnd::arrived:
      return "arrived";
    case NavigationEnd::gave_up:
      return "gave up";
    case NavigationEnd::time_up:
      return "time up";
    case NavigationEnd::fell:
      return "fell over";
    case NavigationEnd::lost:
      return "lost";
  }
  return "";
}

NavigationScore navigate(const NavigationWorld& world, std::uint64_t seed, const std::string& cache_folder) {
  return Drive(world, seed, cache_folder).go();
}

}  // namespace rubble
