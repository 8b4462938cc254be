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

}  // namespace

MissionRobot make_mission_robot(const RobotItem& robot, const std::vector<std::string>& folders,
                                const std::string& key, MeshImporter& importer) {
  if (!robot.urdf.empty()) return make_urdf_robot(robot, find_file(robot.urdf, folders, key), key, importer);
  MissionRobot made;
  made.model = make_bundled(robot);
  return made;
}

Pose calc_base_pose(const RobotItem& robot) {
  constexpr double kDegree = portable::kPi / 180;
  return {portable::quat_from_rpy(robot.rpy_deg.x * kDegree, robot.rpy_deg.y * kDegree,
                                  robot.rpy_deg.z * kDegree),
          robot.position};
}

}  // namespace rubble
