#include "app/navigate/navigation_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "app/navigate/collision_counter.h"
#include "app/navigate/pilot.h"
#include "app/pipeline/stages.h"
#include "kernel/base/portable_math.h"
#include "kernel/robot/bundled.h"
#include "kernel/robot/gaits.h"
#include "kernel/robot/robot_run.h"
#include "kernel/world/world_robots.h"
#include "render/lidar/lidar.h"
#include "scripting/scenario/lidar_scenario.h"

namespace rubble {
namespace {

// The crawler with its flippers half up, so that they climb what is low: body and tracks, and above them the flippers.
constexpr double kFlippers = 0.7;  // unit: rad
const std::vector<NavigatorSlice> kShape{{0.2, 0.46, 0.33}, {0.3, 0.57, 0.33}};
// Tracks that turn on the spot slide: the robot turns by this share of what its belts would give (docs/reference/robots.md).
constexpr double kTurnShare = 0.4;
constexpr double kFallen = 0.3;  // what of the base's Z axis is upright when it lies on its side

// Where the base was at every step since the start; before it stood still.
class PoseHistory {
 public:
  explicit PoseHistory(double step) : step_(step) {}
  void add(const Pose& pose) { poses_.push_back(pose); }
  const Pose& last() const { return poses_.back(); }
  Pose at(double time) const {
    const double place = std::clamp(time / step_, 0.0, double(poses_.size() - 1));
    const auto i = std::min(std::size_t(place), poses_.size() - 1), k = std::min(i + 1, poses_.size() - 1);
    const double t = place - double(i);
    const Pose &a = poses_[i], &b = poses_[k];
    return {portable::slerp(a.rotation, b.rotation, t), a.translation + (b.translation - a.translation) * t};
  }

 private:
  double step_;
  std::vector<Pose> poses_;
};

LidarSpec make_lidar_spec(const NavigationRules& rules) {
  LidarScenario lidar;
  lidar.model = LidarModel::os0, lidar.channels = 32, lidar.columns = 512;
  lidar.rate_hz = 1 / rules.period;
  return lidar.spec();
}

PilotOptions make_pilot_options(const NavigationWorld& world, std::uint64_t seed, const std::string& cache_folder) {
  PilotOptions options;
  options.rules = world.rules(), options.bounds = world.bounds(), options.shape = kShape;
  options.waypoints = world.waypoints(), options.seed = seed, options.cache_folder = cache_folder;
  return options;
}

RobotRunOptions make_run_options(const NavigationWorld& world) {
  const Scenario& scenario = world.mission().scenario;
  RobotRunOptions options;
  options.duration = world.rules().time_limit;
  options.control_hz = 1 / world.rules().period;
  options.fixed_debris = true;  // scans are of the pile as it settled
  options.gravity = scenario.settle.gravity;
  options.lost_below = scenario.settle.lost_below, options.lost_beyond = scenario.settle.lost_beyond;
  options.threads = world.threads();
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
      : world_(world), rules_(world.rules()), model_(make_robot()), history_(make_run_options(world).step),
        lidar_(make_lidar(seed)), pilot_(make_pilot_options(world, seed, cache_folder)),
        collisions_(int(world.pile().pieces.size()), rules_.step_height,
                    [&world](const Vec3& place) { return world.is_solid(place); }) {
    score_.passes = world.passes(), score_.shortest = world.shortest();
    history_.add(world.start());
  }

  NavigationScore go() {
    const RobotRunOptions options = make_run_options(world_);
    RobotRun run(make_laid_pile(world_.mission(), world_.pile()), world_.pile(), options);
    run.add(model_, world_.start(), [this](const RobotSense& sense) { return control(sense); });
    int steps = 0;
    const RobotRunResult result = run.run([&](double) {
      ++steps;
      return take_step(run.world());
    });
    score_.time = steps * options.step;
    score_.path = result.robots.front().path;
    score_.left = distance_to_goal();
    score_.collisions = collisions_.count();
    score_.plans = pilot_.plans(), score_.plans_failed = pilot_.plans_failed();
    score_.hash = result.hash();
    return score_;
  }

 private:
  static RobotModel make_robot() {
    CrawlerOptions options;
    options.flipper_start = kFlippers;
    return make_crawler(options);
  }

  // Its scan k ends when period k begins; the first is of the robot before it starts.
  Lidar make_lidar(std::uint64_t seed) {
    const Scenario& scenario = world_.mission().scenario;
    const std::int64_t start = scenario.start_ns;
    const Pose base_from_lidar{{1, 0, 0, 0}, {0, 0, rules_.lidar_height}};
    const auto place = [this, base_from_lidar, start](std::int64_t stamp) {
      return history_.at(double(stamp - start) * 1e-9 - rules_.period) * base_from_lidar;
    };
    return {make_lidar_spec(rules_), world_.lidar_world(), {place, start}, Medium(scenario.air, scenario.seed), seed,
            world_.threads()};
  }

  RobotCommand control(const RobotSense& sense) {
    const LidarScan scan = lidar_.take(score_.periods++);
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
    return drive_tracks(model_, {output.linear, output.angular / kTurnShare},
                         std::vector<double>(4, kFlippers));
  }

  double time() const { return (score_.periods - 1) * rules_.period; }

  void map(const LidarScan& scan) {
    const int last = int(scan.world_from_lidar.size()) - 1;
    for (const LidarPoint& p : scan.points) {
      const int sample = int(double(p.time) * 1e9 / double(LidarScan::kMotionStep) + 0.5);
      pilot_.see(scan.world_from_lidar[std::size_t(std::min(sample, last))] * Vec3{p.x, p.y, p.z});
    }
  }

  PilotInput make_input(const RobotSense& sense) const {
    const RobotState::Link& base = sense.state.links.front();
    return {time(), base.world_from_link.translation, yaw_of(base.world_from_link), base.linear, base.angular.z};
  }

  bool take_step(const World& world) {
    const RobotState state = world.robots().state(0);
    if (state.lost) end_ = NavigationEnd::lost;
    const Pose& base = state.links.front().world_from_link;
    if (world_.is_inside(base.translation)) score_.inside += distance(base.translation, history_.last().translation);
    history_.add(base);
    if (base.rotation.rotate({0, 0, 1}).z < kFallen) end_ = NavigationEnd::fell;
    collisions_.note(world.robots().contacts(0), base.translation);
    if (end_ != NavigationEnd::time_up) score_.end = end_;
    return end_ == NavigationEnd::time_up;
  }

  double distance_to_goal() const {
    const Vec3 d = history_.last().translation - world_.goal();
    return std::sqrt(d.x * d.x + d.y * d.y);
  }

  const NavigationWorld& world_;
  NavigationRules rules_;
  RobotModel model_;
  PoseHistory history_;
  Lidar lidar_;
  Pilot pilot_;
  CollisionCounter collisions_;
  NavigationScore score_;
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
