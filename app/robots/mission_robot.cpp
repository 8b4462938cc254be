#include "app/robots/mission_robot.h"

#include <algorithm>
#include <filesystem>

#include "app/robots/urdf_robot.h"
#include "kernel/base/error.h"
#include "kernel/base/number_text.h"
#include "kernel/base/portable_math.h"
#include "kernel/base/system/file_sandbox.h"
#include "scripting/robots/robot_kind.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;

std::string find_file(const std::string& name, const std::vector<std::string>& folders,
                      const std::string& key) {
  std::string looked;
  std::error_code failed;
  for (const std::string& folder : folders)
    for (const fs::path& tried : {fs::path(folder) / name, fs::path(folder) / fs::path(name).filename()}) {
      if (fs::is_regular_file(tried, failed)) {
        check_may_read(tried.string(), {"", 0, key + ".urdf", "", "", "", ""});
        return tried.lexically_normal().string();
      }
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

std::size_t find_joint(const RobotModel& model, const std::string& name, const std::string& key) {
  std::string all;
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    if (model.joints[i].kind == JointKind::weld) continue;
    if (model.joints[i].name == name) return i;
    all += (all.empty() ? "one of " : ", ") + model.joints[i].name;
  }
  throw InputError({"", 0, key, "the robot has no such joint that moves", all.empty() ? "nothing: no joint moves" : all,
                    "\"" + name + "\"", ""});
}

// Where joints stand at first; a mimic where what it follows puts it.
void set_starts(const RobotItem& robot, const std::string& key, RobotModel& model) {
  if (model.tube && !robot.start.empty())
    throw InputError({"", 0, key, "the joints of a robot that grows start as it grows", "nothing", "a table", ""});
  for (RobotJoint& joint : model.joints) joint.start = std::clamp(joint.start, joint.lower, joint.upper);
  std::vector<std::size_t> given;
  for (const auto& [name, position] : robot.start) {
    given.push_back(find_joint(model, name, key));
    RobotJoint& joint = model.joints[given.back()];
    if (position < joint.lower || position > joint.upper)
      throw InputError({"", 0, key + "." + name, "outside of the joint's range",
                        plain_text(joint.lower) + " to " + plain_text(joint.upper), plain_text(position), ""});
    joint.start = position;
  }
  for (const MimicJoint& mimic : model.mimics) {
    if (std::find(given.begin(), given.end(), std::size_t(mimic.joint)) != given.end()) continue;
    RobotJoint& joint = model.joints[std::size_t(mimic.joint)];
    const double follows = mimic.multiplier * model.joints[std::size_t(mimic.of)].start + mimic.offset;
    joint.start = std::clamp(follows, joint.lower, joint.upper);
  }
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
  for (const RobotFrame& frame : robot.model.frames) {
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
    made.model = kind_of(robot).make(robot);
  set_starts(robot, key + ".start", made.model);
  for (std::size_t i = 0; i < robot.lamps.size(); ++i)
    made.model.lamps.push_back(place_lamp(robot.lamps[i], made, key + ".lamps[" + std::to_string(i + 1) + "]"));
  return made;
}

OdometryNoise odometry_noise(const Scenario& scenario, std::size_t robot) {
  return {scenario.robots[robot].odometry_noise, scenario.seed, int(robot)};
}

Pose calc_base_pose(const RobotItem& robot, const MissionRobot& made) {
  return Pose{quat_from_degrees(robot.rpy_deg), robot.position} * made.placed_from_base;
}

}  // namespace rubble
