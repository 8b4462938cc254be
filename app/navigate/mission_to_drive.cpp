#include "app/navigate/mission_to_drive.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/mission/scenario_lua.h"
#include "app/navigate/navigation_world.h"
#include "io/base/atomic_file.h"
#include "kernel/base/portable_math.h"
#include "scripting/robots/robot_kind.h"

namespace rubble {
namespace {

constexpr double kDegree = 57.29577951308232;
constexpr char kRobot[] = "crawler";
// Clear of its body and load, which a scanner of a mission sees and that of the benchmark does not; unit: m.
constexpr double kScannerHeight = 0.4;

std::string goal_options(const std::vector<Vec3>& waypoints) {
  std::string text;
  for (const Vec3& w : waypoints) {
    char goal[60];
    std::snprintf(goal, sizeof goal, " --goal %.2f %.2f", w.x, w.y);
    text += goal;
  }
  return text;
}

}  // namespace

Scenario make_mission_to_drive(const NavigationWorld& world) {
  Scenario scenario = world.mission().scenario;
  const Vec3 ahead = world.start().rotation.rotate({1, 0, 0});
  RobotItem robot = make_robot_item("crawler");
  robot.name = kRobot;
  robot.position = world.start().translation, robot.rpy_deg = {0, 0, kDegree * portable::atan2(ahead.y, ahead.x)};
  scenario.robots = {robot};
  scenario.robot_run = {};
  scenario.record_settling = {};  // its camera is on the robot
  SensorItem scanner = make_range_scanner(world.rules(), "points");
  scanner.ride.robot = kRobot, scanner.position = {0, 0, kScannerHeight};
  scenario.sensors = {scanner};
  scenario.trajectory = {};
  scenario.trajectory.rate_hz = 10;
  scenario.trajectory.ride.robot = kRobot, scenario.trajectory.ride.position = {0.3, 0, 0.3};
  return scenario;
}

std::vector<Vec3> waypoints_from_start(const NavigationWorld& world) {
  const Pose start_from_world = world.start().inverse();
  std::vector<Vec3> waypoints;
  for (const Vec3& w : world.waypoints()) {
    const Vec3 place = start_from_world * w;
    waypoints.push_back({place.x, place.y, 0});
  }
  return waypoints;
}

void write_mission_to_drive(const std::string& folder, std::uint64_t seed, const NavigationWorld& world, bool packs) {
  const std::vector<Vec3> waypoints = waypoints_from_start(world);
  const std::string name = folder + "/" + std::to_string(seed);
  write_text_file(name + ".lua",
                  scenario_to_lua(with_whole_paths(make_mission_to_drive(world), world.mission().assets, packs),
                                  "Pile " + std::to_string(seed) + " of `rubble bench navigate`, to be driven through over "
                                  "ROS 1 (docs/explanation/autonomy.md):\n  rubble drive " + std::to_string(seed) + ".lua --ros1 &\n"
                                  "  ros1_navigator" + goal_options(waypoints)));
  nlohmann::ordered_json json;
  json["seed"] = seed;
  for (const Vec3& w : waypoints) json["goals"].push_back({w.x, w.y});
  json["shortest_m"] = world.shortest(), json["passes"] = world.passes();
  write_text_file(name + ".json", json.dump(2) + "\n");
}

}  // namespace rubble
