// A robot while it is made from a URDF file and what its mission says of it. For urdf_robot.cpp and urdf_drive.cpp.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "app/robots/mission_robot.h"
#include "io/robot/urdf_reader.h"
#include "kernel/base/error.h"
#include "scripting/robots/robot_item.h"

namespace rubble {

struct UrdfDraft {
  const UrdfFile& file;
  const RobotItem& robot;
  std::string key;                               // of the robot in the mission
  MissionRobot made{};
  std::vector<int> body_lines{}, joint_lines{};  // by body, by joint of the model
  std::vector<Diagnostic> mistakes{};

  void add_mistake(int line, const std::string& what, const std::string& message, const std::string& expected,
                   const std::string& found) {
    mistakes.push_back({file.path, line, what, message, expected, found, ""});
  }
  // member: of the mission's table.
  void refuse_key(const std::string& member, const std::string& message, const std::string& expected, const std::string& found) {
    mistakes.push_back({"", 0, key + "." + member, message, expected, found, ""});
  }
  // Of the model; -1: it has none of that name.
  int find_joint(const std::string& name) const {
    const std::vector<RobotJoint>& joints = made.model.joints;
    const auto at = std::find_if(joints.begin(), joints.end(), [&](const RobotJoint& joint) { return joint.name == name; });
    return at == joints.end() ? -1 : int(at - joints.begin());
  }
};

// The model's SideDrive, of the tracks and of the wheels that the mission names; nothing where it names none. The model
// has its bodies, joints and parts, and for wheels its motors, already.
void add_tracks(UrdfDraft& draft);
void add_wheels(UrdfDraft& draft);

}  // namespace rubble
