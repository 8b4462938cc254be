#include "app/robots/mission_robot.h"

#include <algorithm>
#include <filesystem>

#include "app/robots/urdf_robot.h"
#include "kernel/base/error.h"
#include "kernel/base/portable_math.h"
#include "kernel/robot/bundled.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;

VineOptions vine_options(const RobotItem& robot) {
  VineOptions options;
  options.tube.pressure = robot.pressure;
  options.tube.radius = robot.radius;
  options.tube.link_length = robot.link_length;
  options.tube.links = count_vine_links(robot.length, robot.link_length);
  options.tube.start_links = std::min(options.tube.start_links, options.tube.links);
  options.friction = robot.friction.value_or(options.friction);
  return options;
}

RobotModel make_bundled(const RobotItem& robot) {
  if (robot.model == RobotKind::snake) {
    SnakeOptions options;
    options.modules = robot.modules;
    options.friction = robot.friction.value_or(options.friction);
    return make_snake(options);
  }
  if (robot.model == RobotKind::crawler) {
    CrawlerOptions options;
    options.flippers = robot.flippers;
    options.friction = robot.friction.value_or(options.friction);
    return make_crawler(options);
  }
  if (robot.model == RobotKind::vine) return make_vine(vine_options(robot));
  RoverOptions options;
  options.friction = robot.friction.value_or(options.friction);
  return make_rover(options);
}

std::string find_file(const std::string& name, const std::vector<std::string>& folders,
                      const std::string& key) {
  std::string looked;
  std::error_code failed;
  for (const std::string& folder : folders)
    for (const fs::path& tried : {fs::path(folder) / name, fs::path(folder) / fs::path(name).filename()}) {
      if (fs::is_regular_file(tried, failed)) return tried.lexically_normal().string();
      looked += (looked.empty() ? "" : ", ") + tried.string();
    }
  throw InputError({"", 0, key + ".urdf", "no such file", "a URDF file", "\"" + name + "\"",
                    "looked for " + looked});
}

Quat quat_from_degrees(const Vec3& rpy_deg) {
  constexpr double kDegree = portable::kPi / 180;
  return portable::quat_from_rpy(rpy_deg.x * kDegree, rpy_deg.y * kDegree, rpy_deg.z * kDegree);
}

// key: of the lamp, "robots[1].lamps[1]"
RobotLamp place_lamp(const LampItem& item, const MissionRobot& robot, const std::string& key) {
  RobotLamp lamp = robot.model.headlamp;
  if (!item.link.empty()) {
    const RiddenLink on = find_link(robot, item.link, key);
    lamp.link = int(on.link), lamp.link_from_lamp = on.link_from_rider;
  } else if (item.position) {
    lamp.link_from_lamp = {};
  }
  const RobotLink& link = robot.model.links[std::size_t(lamp.link)];
  if (link.parts.empty() && link.looks.triangles.empty())
    throw InputError({"", 0, key + ".link", "the link has no shape that could carry a lamp", "a link that is seen",
                      "\"" + link.name + "\"", ""});
  lamp.link_from_lamp = lamp.link_from_lamp * Pose{quat_from_degrees(item.rpy_deg), item.position.value_or(Vec3())};
  lamp.intensity_cd = item.intensity_cd, lamp.cone_deg = item.cone_deg;
  return lamp;
}

}  // namespace

RiddenLink find_link(const MissionRobot& robot, const std::string& name, const std::string& key) {
  RiddenLink ridden;
  const std::vector<RobotLink>& links = robot.model.links;
  std::string all;
  for (ridden.link = 0; ridden.link < links.size(); ++ridden.link) {
    if (name.empty() || links[ridden.link].name == name) return ridden;
    all += (all.empty() ? "one of " : ", ") + links[ridden.link].name;
  }
  for (const RobotFrame& frame : robot.frames) {
    if (frame.name == name) return {std::size_t(frame.link), frame.link_from_frame};
    all += ", " + frame.name;
  }
  throw InputError({"", 0, key + ".link", "the robot has no such link", all, "\"" + name + "\"", ""});
}

MissionRobot make_mission_robot(const RobotItem& robot, const std::vector<std::string>& folders,
                                const std::string& key, MeshImporter& importer) {
  MissionRobot made;
  if (!robot.urdf.empty())
    made = make_urdf_robot(robot, find_file(robot.urdf, folders, key), key, importer);
  else
    made.model = make_bundled(robot);
  for (std::size_t i = 0; i < robot.lamps.size(); ++i)
    made.model.lamps.push_back(place_lamp(robot.lamps[i], made, key + ".lamps[" + std::to_string(i + 1) + "]"));
  return made;
}

OdometryNoise odometry_noise(const Scenario& scenario, std::size_t robot) {
  return {scenario.robots[robot].odometry_noise, scenario.seed, int(robot)};
}

Pose calc_base_pose(const RobotItem& robot) { return {quat_from_degrees(robot.rpy_deg), robot.position}; }

}  // namespace rubble
