#include <algorithm>
#include <cmath>

#include "kernel/model/everting_tube.h"
#include "scripting/scenario/robot_scenario.h"
#include "scripting/scenario/scenario.h"
#include "scripting/schema/schema.h"
#include "scripting/values/value.h"

namespace rubble {
namespace {

constexpr const char* kModelNames[] = {"snake", "crawler", "rover", "vine"};

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
  k.value("linear", leg.linear, "Crawler and rover: forward velocity.").between(-5, 5).unit("m/s");
  k.value("angular", leg.angular, "Crawler and rover: angular velocity, counter-clockwise.")
      .between(-10, 10)
      .unit("rad/s");
  k.value("flippers_deg", leg.flippers_deg,
          "Crawler: angles of the flippers front left, front right, rear left, rear right; 0: level, "
          "positive: raised.")
      .between(-180, 180)
      .unit("degree");
  k.choice("gait", leg.gait,
           {"lateral_undulation", "sidewinding", "rolling", "serpenoid", "helical_rolling"},
           "Snake: the gait.");
  k.value("rate", leg.rate, "Snake: angular frequency of the waves; negative: backwards.")
      .between(-20, 20)
      .unit("rad/s");
  k.value("phase", leg.phase, "Snake: phase of the waves in addition to rate * t; for a smooth change of `rate`.")
      .between(-1e6, 1e6)
      .unit("rad");
  k.value("amplitude", leg.amplitude, "Snake: amplitude, relative to that of the gait.")
      .between(0, 2);
  k.value("steering_deg", leg.steering_deg, "Snake: offset of the sideways joints.")
      .between(-45, 45)
      .unit("degree");
  k.value("joints", leg.joints,
          "Positions of all motors, in their order, instead of the other keys; sliders in m.")
      .between(-1000, 1000)
      .unit("rad");
  k.value("joint_names", leg.joint_names, "Names of the joints of `joints`; not given: all motors.");
  k.value("growth", leg.growth, "Vine: speed of the tip; negative: retracts.").between(-1, 1).unit("m/s");
  k.value("curvature", leg.curvature, "Vine: curvature of new links, to the left.").between(-5, 5).unit("1/m");
  k.value("curvature_up", leg.curvature_up, "Vine: curvature of new links, upwards.").between(-5, 5).unit("1/m");
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
                          "more than " + format_number(robot.drive[k - 1].t) + " s",
                          format_number(robot.drive[k].t) + " s", ""});
    const std::size_t flippers = robot.drive[k].flippers_deg.size();
    if (flippers != 0 && flippers != 4)
      mistakes.push_back({"", 0, leg + ".flippers_deg", "wrong number of angles",
                          "front left, front right, rear left, rear right",
                          std::to_string(flippers), ""});
    const std::size_t joints = robot.drive[k].joints.size(), names = robot.drive[k].joint_names.size();
    if (names != 0 && names != joints)
      mistakes.push_back({"", 0, leg + ".joint_names", "not as many as joints", std::to_string(joints) + " names",
                          std::to_string(names), ""});
  }
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
  check_sides("wheels", robot.left_wheels, robot.right_wheels);
  check_sides("tracks", robot.left_tracks, robot.right_tracks);
  if (!robot.left_wheels.empty() && !robot.left_tracks.empty())
    mistakes.push_back({"", 0, key_of(i, "left_tracks"), "contradicts left_wheels", "one of both", "both",
                        "wheels inside of a track do not touch the ground: leave them out"});
  if (robot.control > 0 && !robot.drive.empty())
    mistakes.push_back({"", 0, key_of(i, "drive"), "contradicts control", "one of both", "both", ""});
}

void check_vine(const RobotItem& robot, std::size_t i, std::vector<Diagnostic>& mistakes) {
  if (!robot.urdf.empty() || robot.model != RobotKind::vine) return;
  const double links = std::floor(robot.length / robot.link_length + 1e-9);
  if (links < 1)
    mistakes.push_back({"", 0, key_of(i, "length"), "shorter than a link",
                        "link_length (" + format_number(robot.link_length) + " m) or more",
                        format_number(robot.length) + " m", "a shorter link_length makes more of a short vine"});
  if (links > kMostTubeLinks)
    mistakes.push_back({"", 0, key_of(i, "length"), "too many links",
                        std::to_string(kMostTubeLinks) + " links of link_length or fewer",
                        format_number(links), "a longer link_length needs fewer"});
}

// They light what the cameras see, as other lights do.
void check_lamps(const Scenario& scenario, std::vector<Diagnostic>& mistakes) {
  const std::size_t lamps = count_lamps(scenario.robots);
  if (lamps == 0 || lamps + scenario.lights.size() <= kMostLights) return;
  mistakes.push_back({"", 0, "robots", "too many lamps",
                      "at most " + std::to_string(kMostLights - 1) + " lamps of robots and `lights` together",
                      std::to_string(lamps) + " and " + std::to_string(scenario.lights.size() - 1), ""});
}

// What a function is to be told of must be there.
void check_senses(const Scenario& scenario, std::size_t i, std::vector<Diagnostic>& mistakes) {
  const RobotItem& robot = scenario.robots[i];
  if (robot.senses.empty()) return;
  if (robot.control == 0)
    mistakes.push_back({"", 0, key_of(i, "senses"), "there is no controller", "a function as `control`", "no function", ""});
  std::vector<std::string> names;
  for (const LidarScenario& lidar : scenario.lidars) names.push_back(lidar.name);
  for (const MountedCamera& camera : scenario.cameras) {
    names.push_back(camera.name);
    names.push_back(colour_sense(camera.name));
  }
  for (const ImuScenario& imu : scenario.imus) names.push_back(imu.name);
  for (const SensorItem& sensor : scenario.sensors) names.push_back(sensor.name);
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "one of " : ", ") + name;
  for (std::size_t k = 0; k < robot.senses.size(); ++k) {
    if (std::find(names.begin(), names.end(), robot.senses[k]) != names.end()) continue;
    mistakes.push_back({"", 0, key_of(i, "senses[" + std::to_string(k + 1) + "]"),
                        "no sensor has this name", all, "\"" + robot.senses[k] + "\"", ""});
  }
}

// at: the key of the ride, such as "cameras.front.ride"
void check_carrier(const Carrier& ride, const std::string& at, const std::vector<std::string>& names,
                   std::vector<Diagnostic>& mistakes) {
  if (!ride.on() && !ride.link.empty())
    mistakes.push_back({"", 0, at + ".link", "a link without a robot", at + ".robot as well", "\"" + ride.link + "\"", ""});
  if (!ride.on() || std::find(names.begin(), names.end(), ride.robot) != names.end()) return;
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "one of " : ", ") + name;
  mistakes.push_back({"", 0, at + ".robot", "no robot has this name",
                      all.empty() ? "a robot in `robots`" : all, "\"" + ride.robot + "\"", ""});
}

void check_ride(const Scenario& scenario, const std::vector<std::string>& names,
                std::vector<Diagnostic>& mistakes) {
  const TrajectorySpec& path = scenario.trajectory;
  check_carrier(path.ride, "trajectory.ride", names, mistakes);
  if (!path.ride.on()) return;
  const auto add = [&](const char* key, const char* message, const char* expected,
                       const std::string& found) {
    mistakes.push_back({"", 0, key, message, expected, found, ""});
  };
  if (path.waypoints.size() > 1)
    add("trajectory.waypoints", "contradicts ride", "one of both", "both");
  if (path.limits.any() || path.smoothing || path.duration || path.rest_at_ends ||
      path.plan != Plan::ghost)
    add("trajectory.ride", "the path of a robot cannot be changed", "rate_hz only",
        "limits, smoothing, a duration or a plan");
}

// What a link carries is on no rig: formats that know one moving body alone cannot hold both.
void check_sensor_rides(const Scenario& scenario, const std::vector<std::string>& names,
                        std::vector<Diagnostic>& mistakes) {
  bool mixed = false;
  for (const MountedCamera& camera : scenario.cameras) {
    check_carrier(camera.ride, camera.key() + ".ride", names, mistakes);
    mixed = mixed || !(camera.ride == scenario.cameras.front().ride);
  }
  for (const LidarScenario& lidar : scenario.lidars)
    check_carrier(lidar.ride, "lidars." + lidar.name + ".ride", names, mistakes);
  for (const ImuScenario& imu : scenario.imus) check_carrier(imu.ride, imu.key() + ".ride", names, mistakes);
  for (const SensorItem& sensor : scenario.sensors) check_carrier(sensor.ride, sensor.key() + ".ride", names, mistakes);
  const auto on_rig = [](const auto& sensor) { return !sensor.ride.on(); };
  const bool unseen = std::none_of(scenario.cameras.begin(), scenario.cameras.end(), on_rig);
  if (unseen && (scenario.has_unit_on_rig() ||
                 std::any_of(scenario.sensors.begin(), scenario.sensors.end(), on_rig) ||
                 std::any_of(scenario.lidars.begin(), scenario.lidars.end(), on_rig)))
    mistakes.push_back({"", 0, "cameras", "no camera is on the rig, but another sensor is",
                        "a camera on the rig, or a `ride` for every other sensor on it", "", ""});
  if (mixed && scenario.outputs.euroc)
    mistakes.push_back({"", 0, "outputs.euroc", "the format has one moving body",
                        "cameras on one carrier, or another format", "cameras on several", ""});
}

}  // namespace

void add_ride_keys(Schema& k, const std::string& at, Carrier& ride) {
  k.group(at + "ride", "Link of a robot that carries the sensor, instead of the rig.");
  k.value(at + "ride.robot", ride.robot, "Name of the robot.");
  k.value(at + "ride.link", ride.link, "Link of the robot; not given: the first link.");
}

void add_robot_keys(Schema& k, Scenario& s) {
  std::vector<RobotItem>& list = s.robots;
  k.list("robots", list, "Robots that are driven through the settled pile (docs/reference/robots.md).");
  k.add("robots[].model", "Bundled robot.", [&list](std::size_t i) {
    return Schema::choice_slot(list[i].model, {kModelNames[0], kModelNames[1], kModelNames[2], kModelNames[3]});
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
  k.item("robots[].left_tracks", list, &RobotItem::left_tracks,
         "URDF robot: links around which the left tracks run, for `linear`, `angular` and odometry.");
  k.item("robots[].right_tracks", list, &RobotItem::right_tracks, "URDF robot: likewise on the right.");
  k.item("robots[].track_speed", list, &RobotItem::track_speed, "URDF robot: largest speed of these tracks.")
      .between(0.01, 20)
      .unit("m/s");
  k.item("robots[].name", list, &RobotItem::name,
         "Name in files and topics; not given: the model and a number.");
  k.item("robots[].position", list, &RobotItem::position,
         "Position of the base frame: on the ground between tracks or wheels, at the centre of a snake's head, or at "
         "the centre of the opening that a vine grows from.")
      .between(-1000, 1000)
      .unit("m");
  k.item("robots[].rpy_deg", list, &RobotItem::rpy_deg,
         "Roll, pitch and yaw: Rz(yaw) Ry(pitch) Rx(roll).")
      .between(-360, 360)
      .unit("degree");
  k.item("robots[].modules", list, &RobotItem::modules, "Snake: number of modules.").between(2, 64);
  k.item("robots[].flippers", list, &RobotItem::flippers, "Crawler: has flippers.");
  k.item("robots[].pressure", list, &RobotItem::pressure, "Vine: gauge pressure in the tube.")
      .above(0, 1e6)
      .unit("Pa");
  k.item("robots[].radius", list, &RobotItem::radius, "Vine: radius of the tube.").between(0.01, 0.3).unit("m");
  k.item("robots[].length", list, &RobotItem::length, "Vine: largest length, at least one link.")
      .above(0, 100)
      .unit("m");
  k.item("robots[].link_length", list, &RobotItem::link_length,
         "Vine: length of the rigid links that model the tube.")
      .between(0.02, 0.5)
      .unit("m");
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
         "Names of the LiDARs, cameras and IMUs whose scans, depths and readings `control` gets; colours: the name "
         "with \".rgb\" (docs/reference/robots.md).");
  k.group("robot_run", "Duration and rate of the drive.");
  k.value("robot_run.duration", s.robot_run.duration, "Duration of the drive.")
      .above(0, 86400)
      .unit("s");
  k.value("robot_run.control_hz", s.robot_run.control_hz, "Rate of the commands.")
      .between(1, 240)
      .unit("Hz");
  k.choice("robot_run.debris", s.robot_run.debris, {"free", "fixed"},
           "`free`: pieces move when robots push them; `fixed`: pieces do not move.");
}

std::size_t count_lamps(const std::vector<RobotItem>& robots) {
  std::size_t lamps = 0;
  for (const RobotItem& robot : robots) lamps += robot.lamps.size();
  return lamps;
}

std::vector<std::string> robot_names(const std::vector<RobotItem>& robots) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const RobotItem& robot = robots[i];
    names.push_back(!robot.name.empty() ? robot.name
                                        : std::string(robot.urdf.empty() ? kModelNames[int(robot.model)]
                                                                       : "robot") +
                                              "_" +
                                              std::to_string(i + 1));
  }
  return names;
}

void check_robots(const Scenario& scenario, std::vector<Diagnostic>& mistakes) {
  const std::vector<std::string> names = robot_names(scenario.robots);
  if (!names.empty() && scenario.record_settling.on)
    mistakes.push_back({"", 0, "record_settling", "robots start with the first frame",
                        "one of robots and record_settling", "both", ""});
  check_ride(scenario, names, mistakes);
  check_sensor_rides(scenario, names, mistakes);
  check_lamps(scenario, mistakes);
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
    check_legs(scenario.robots[i], i, mistakes);
    check_senses(scenario, i, mistakes);
    check_vine(scenario.robots[i], i, mistakes);
  }
}

}  // namespace rubble
