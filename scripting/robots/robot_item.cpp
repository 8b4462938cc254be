#include "scripting/robots/robot_item.h"

#include <algorithm>

#include "kernel/base/number_text.h"
#include "scripting/robots/robot_kind.h"
#include "scripting/schema/schema.h"
#include "scripting/values/value.h"

namespace rubble {
namespace {

Schema lamp_schema(LampItem& lamp) {
  Schema k;
  k.value("link", lamp.link, "Link that carries the lamp. Empty: the link of the headlamp, otherwise the base.");
  k.value("position", lamp.position, "Position on the link. Not given: that of the headlamp, otherwise the origin of "
                                     "the link.")
      .between(-10, 10)
      .unit("m");
  k.value("rpy_deg", lamp.rpy_deg, "Direction of the beam, from the X axis of the link: roll, pitch (positive: "
                                   "down), yaw.")
      .between(-360, 360)
      .unit("degree");
  k.value("intensity_cd", lamp.intensity_cd, "Luminous intensity on the axis.").between(0, 100000).unit("cd");
  k.value("cone_deg", lamp.cone_deg, "Full angle of the cone.").between(1, 170).unit("degree");
  return k;
}

Schema leg_schema(RobotLeg& leg) {
  Schema k;
  k.value("t", leg.t, "Start of this command, in time since the start of the drive.").between(0, 86400).unit("s");
  k.value("linear", leg.linear, "Tracks and driven wheels: forward velocity.").between(-5, 5).unit("m/s");
  k.value("angular", leg.angular, "Tracks and driven wheels: angular velocity, counter-clockwise.")
      .between(-10, 10)
      .unit("rad/s");
  k.value("flippers_deg", leg.flippers_deg,
          "Tracked robots: angles of the flippers, of the crawler front left, front right, rear left, rear right; 0: "
          "level, positive: raised.")
      .between(-180, 180)
      .unit("degree");
  k.value("joints", leg.joints,
          "Positions of all motors, in their order, instead of the other keys; sliders in m.")
      .between(-1000, 1000)
      .unit("rad");
  k.value("joint_names", leg.joint_names, "Names of the joints of `joints`; not given: all motors.");
  for (const auto& figures : leg.figures.all()) figures->add_keys(k);
  return k;
}

std::string key_of(std::size_t robot, const std::string& member) {
  return "robots[" + std::to_string(robot + 1) + "]." + member;
}

void check_legs(const RobotItem& robot, std::size_t i, std::vector<Diagnostic>& mistakes) {
  for (std::size_t k = 0; k < robot.drive.size(); ++k) {
    const std::string leg = key_of(i, "drive[" + std::to_string(k + 1) + "]");
    if (k > 0 && robot.drive[k].t <= robot.drive[k - 1].t)
      mistakes.push_back({"", 0, leg + ".t", "not in order",
                          "more than " + exact_text(robot.drive[k - 1].t) + " s",
                          exact_text(robot.drive[k].t) + " s", ""});
    const std::size_t joints = robot.drive[k].joints.size(), names = robot.drive[k].joint_names.size();
    if (names != 0 && names != joints)
      mistakes.push_back({"", 0, leg + ".joint_names", "not as many as joints", std::to_string(joints) + " names",
                          std::to_string(names), ""});
  }
  if (robot.control > 0 && !robot.drive.empty())
    mistakes.push_back({"", 0, key_of(i, "drive"), "contradicts control", "one of both", "both", ""});
}

void check_file_keys(const RobotItem& robot, std::size_t i, std::vector<Diagnostic>& mistakes) {
  const std::pair<const char*, bool> of_files[] = {{"urdf_arguments", !robot.urdf_arguments.empty()},
                                                    {"efforts", !robot.efforts.empty()},
                                                    {"speeds", !robot.speeds.empty()}};
  for (const auto& [member, given] : of_files)
    if (robot.urdf.empty() && given)
      mistakes.push_back({"", 0, key_of(i, member), "only a robot from a URDF file has these", "nothing", "a table", ""});
  const auto check_sides = [&](const std::string& what, const std::vector<std::string>& left, const std::vector<std::string>& right) {
    if (robot.urdf.empty() && (!left.empty() || !right.empty()))
      mistakes.push_back({"", 0, key_of(i, (left.empty() ? "right_" : "left_") + what),
                          "only a robot from a URDF file has these", "nothing", "a list", ""});
    if (left.empty() != right.empty())
      mistakes.push_back({"", 0, key_of(i, (left.empty() ? "left_" : "right_") + what), "missing",
                          "both of left_" + what + " and right_" + what + ", or neither", "one of them", ""});
  };
  if (!robot.steering.empty() && robot.left_wheels.empty())
    mistakes.push_back({"", 0, key_of(i, "steering"), "no wheel is driven", "left_wheels and right_wheels of a URDF robot as well", "neither", ""});
  check_sides("wheels", robot.left_wheels, robot.right_wheels);
  check_sides("tracks", robot.left_tracks, robot.right_tracks);
  if (!robot.left_wheels.empty() && !robot.left_tracks.empty())
    mistakes.push_back({"", 0, key_of(i, "left_tracks"), "contradicts left_wheels", "one of both", "both",
                        "wheels inside of a track do not touch the ground: leave them out"});
}

// Keys of one robot's own figures as keys of the list.
void add_figure_keys(Schema& k, std::vector<RobotItem>& list) {
  const FiguresOfKinds usual = make_robot_figures();
  for (std::size_t kind = 0; kind < usual.all().size(); ++kind) {
    Schema own;
    usual.all()[kind]->add_keys(own);
    for (std::size_t n = 0; n < own.keys().size(); ++n) {
      const Key& key = own.keys()[n];
      Key& added = k.add("robots[]." + key.path, key.doc_text, [&list, kind, n](std::size_t i) {
        Schema of_item;
        list[i].figures.all()[kind]->add_keys(of_item);
        return of_item.keys()[n].bind(0);
      });
      added.unit_text = key.unit_text, added.range = key.range;
    }
  }
}

}  // namespace

FiguresOfKinds make_robot_figures() {
  FiguresOfKinds figures;
  for (const RobotKind* kind : robot_kinds()) figures.add(kind->figures());
  return figures;
}

FiguresOfKinds make_command_figures() {
  FiguresOfKinds figures;
  for (const RobotKind* kind : robot_kinds()) figures.add(kind->command_figures());
  return figures;
}

bool same_command(const RobotLeg& a, const RobotLeg& b) {
  return a.linear == b.linear && a.angular == b.angular && a.flippers_deg == b.flippers_deg && a.flippers == b.flippers &&
         a.joints == b.joints && a.joint_names == b.joint_names && a.figures == b.figures;
}

void add_robot_item_keys(Schema& k, std::vector<RobotItem>& list) {
  k.list("robots", list, "Robots that are driven through the settled pile (docs/reference/robots.md).");
  k.add("robots[].model", "Bundled robot.", [&list](std::size_t i) {
    std::vector<std::string> names;
    for (const RobotKind* kind : robot_kinds()) names.push_back(kind->name());
    return Schema::choice_slot(list[i].model, std::move(names));
  });
  k.item("robots[].urdf", list, &RobotItem::urdf,
         "Instead of a bundled robot: a URDF file, relative to the script (docs/reference/robots.md).");
  k.item("robots[].urdf_arguments", list, &RobotItem::urdf_arguments,
         "URDF robot: arguments of a `.xacro` file, by name.");
  k.item("robots[].efforts", list, &RobotItem::efforts,
         "URDF robot: largest motor torque, by joint, instead of that in the file; sliders in N.")
      .between(0, 1e9)
      .unit("N m");
  k.item("robots[].speeds", list, &RobotItem::speeds,
         "URDF robot: largest motor speed, by joint, instead of that in the file; sliders in m/s; 0: no limit.")
      .between(0, 1e9)
      .unit("rad/s");
  k.item("robots[].start", list, &RobotItem::start,
         "Joint positions at the start, by joint; sliders in m. Other joints start at 0, or at the nearest position "
         "in their range.")
      .between(-1000, 1000)
      .unit("rad");
  k.item("robots[].left_wheels", list, &RobotItem::left_wheels,
         "URDF robot: joints of the driven wheels on the left, for `linear`, `angular` and odometry.");
  k.item("robots[].right_wheels", list, &RobotItem::right_wheels,
          "URDF robot: joints of the driven wheels on the right.");
  k.item("robots[].wheel_radius", list, &RobotItem::wheel_radius, "URDF robot: radius of these wheels.")
      .between(0.001, 10)
      .unit("m");
  k.item("robots[].steering", list, &RobotItem::steering,
         "URDF robot: joints that steer wheels about the vertical axis, as those of a car; with left_wheels and right_wheels.");
  k.item("robots[].left_tracks", list, &RobotItem::left_tracks,
         "URDF robot: links around which the left tracks run, for `linear`, `angular` and odometry.");
  k.item("robots[].right_tracks", list, &RobotItem::right_tracks, "URDF robot: likewise on the right.");
  k.item("robots[].track_speed", list, &RobotItem::track_speed, "URDF robot: largest speed of these tracks.")
      .between(0.01, 20)
      .unit("m/s");
  k.item("robots[].name", list, &RobotItem::name,
         "Name in files and topics; not given: the model and a number.");
  k.item("robots[].position", list, &RobotItem::position,
         "Position of the base frame (docs/reference/robots.md): of the crawler and the rover on the ground between tracks "
         "or wheels.")
      .between(-1000, 1000)
      .unit("m");
  k.item("robots[].rpy_deg", list, &RobotItem::rpy_deg,
         "Roll, pitch and yaw: Rz(yaw) Ry(pitch) Rx(roll).")
      .between(-360, 360)
      .unit("degree");
  add_figure_keys(k, list);
  k.item("robots[].friction", list, &RobotItem::friction,
         "Coulomb coefficient of tracks, wheels or skin against concrete; not given: that of the model.")
      .between(0, 2);
  k.item("robots[].odometry_noise", list, &RobotItem::odometry_noise,
         "Standard deviation of the distance that the tracks or wheels of one side report over 1 m; it grows with "
         "the square root of the distance. 0: exact; 0.001: as published for tracks (docs/reference/robots.md).")
      .between(0, 0.1)
      .unit("m");
  k.add("robots[].lamps", "Spot lights on links, in addition to the `lamp` of cameras. `{ {} }` switches the "
                          "headlamp on.",
        [&list](std::size_t i) { return Schema::table_list(list[i].lamps, lamp_schema); });
  k.add("robots[].drive", "Commands, each from its time `t` on; empty: the robot stands still.",
        [&list](std::size_t i) { return Schema::table_list(list[i].drive, leg_schema); });
  k.item("robots[].control", list, &RobotItem::control,
         "Instead of `drive`: a function that returns commands, registered by rubble.controller.")
      .between(0, 1000);
  k.item("robots[].senses", list, &RobotItem::senses,
         "Names of the sensors whose scans, depths and readings `control` gets; colours: the name "
         "with \".rgb\" (docs/reference/robots.md).");
}

std::size_t count_lamps(const std::vector<RobotItem>& robots) {
  std::size_t lamps = 0;
  for (const RobotItem& robot : robots) lamps += robot.lamps.size();
  return lamps;
}

std::vector<std::string> robot_names(const std::vector<RobotItem>& robots) {
  std::vector<std::string> names;
  for (const RobotItem& robot : robots)
    names.push_back(!robot.name.empty() ? robot.name : kind_of(robot).name() + "_" + std::to_string(names.size() + 1));
  return names;
}

void check_robot_items(const std::vector<RobotItem>& robots, std::vector<Diagnostic>& mistakes) {
  const std::vector<std::string> names = robot_names(robots);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const bool plain = std::all_of(names[i].begin(), names[i].end(), [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    });
    if (!plain)
      mistakes.push_back({"", 0, key_of(i, "name"), "cannot name a file",
                          "letters, digits and _", "\"" + names[i] + "\"", ""});
    if (std::find(names.begin(), names.begin() + std::ptrdiff_t(i), names[i]) !=
        names.begin() + std::ptrdiff_t(i))
      mistakes.push_back({"", 0, key_of(i, "name"), "another robot has this name",
                          "a name of its own", "\"" + names[i] + "\"", ""});
    check_legs(robots[i], i, mistakes);
    check_file_keys(robots[i], i, mistakes);
    kind_of(robots[i]).check(robots[i], key_of(i, ""), mistakes);
  }
}

}  // namespace rubble
