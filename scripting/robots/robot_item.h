// The robots of a mission: which, where, and how they are driven.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kernel/base/error.h"
#include "kernel/base/math.h"
#include "scripting/robots/robot_figures.h"

namespace rubble {

// Of all kinds, with their defaults: of a robot, and of its commands.
FiguresOfKinds make_robot_figures();
FiguresOfKinds make_command_figures();

// How a robot is driven from a time on.
struct RobotLeg {
  double t = 0;       // since the start; unit: s; range: 0 to 86400
  double linear = 0;  // of what tracks or wheels drive, forwards; unit: m/s; range: -5 to 5
  double angular = 0; // counter-clockwise; unit: rad/s; range: -10 to 10
  // Of a tracked robot's flippers, in the order of their motors; empty: as at the start. unit: degree; of functions: rad
  std::vector<double> flippers_deg{}, flippers{};
  std::vector<double> joints{};  // positions of motors, beside the rest; unit: rad, slider m
  std::vector<std::string> joint_names{};  // whose they are; empty: all motors, in their order
  FiguresOfKinds figures = make_command_figures();
};

// Whether both ask for the same, from whatever time on.
bool same_command(const RobotLeg& a, const RobotLeg& b);

// A lamp of a robot.
struct LampItem {
  std::string link{};               // empty: that of the model's headlamp
  std::optional<Vec3> position{};   // on the link; not given: the headlamp; unit: m
  Vec3 rpy_deg;                     // of its beam, from the link's X
  double intensity_cd = 100;        // on its axis; range: 0 to 100000
  double cone_deg = 70;             // full angle; range: 1 to 170
};

struct RobotItem {
  int model = 0;       // its kind: index into robot_kinds()
  std::string urdf{};  // a file, instead of a bundled model: relative to the script
  std::vector<std::pair<std::string, std::string>> urdf_arguments{};  // of a .xacro file, by name
  // By joint of a robot from a file: instead of what its <limit> gives. unit: N m, slider N; rad/s, slider m/s
  std::vector<std::pair<std::string, double>> efforts{}, speeds{};
  // By joint: where it stands at first. Others: 0, or where their range is nearest to it. unit: rad, slider m
  std::vector<std::pair<std::string, double>> start{};
  // Of a robot from a file: the joints of its driven wheels, whose axes point left. Neither: twists do not
  // drive it and it has no odometry.
  std::vector<std::string> left_wheels{}, right_wheels{};
  double wheel_radius = 0.1;  // unit: m; range: 0.001 to 10
  std::vector<std::string> steering{};  // the joints that turn wheels about the vertical axis, as those of a car
  // Of a robot from a file: the links around which tracks run, instead of driven wheels.
  std::vector<std::string> left_tracks{}, right_tracks{};
  double track_speed = 1;  // at most; unit: m/s; range: 0.01 to 20
  std::string name{};  // empty: the model's, numbered
  Vec3 position;       // of its base frame, in the world; unit: m
  Vec3 rpy_deg;        // R = Rz(yaw) Ry(pitch) Rx(roll)
  FiguresOfKinds figures = make_robot_figures();
  std::optional<double> friction{};  // against concrete; not given: the model's; range: 0 to 2
  double odometry_noise = 0;  // standard deviation of a side's way over one metre; unit: m; range: 0 to 0.1; 0: exact
  std::vector<LampItem> lamps{};     // that shine
  std::vector<RobotLeg> drive{};     // in rising order of t; empty: it stands still
  int control = 0;  // number of a function of the script that drives it instead; 0: none
  std::vector<std::string> senses{};  // sensors whose readings that function is told; see colour_sense()
};

// The keys `robots` with all of their items. The list must outlive the schema.
void add_robot_item_keys(Schema& keys, std::vector<RobotItem>& robots);
// Of single robots: names, commands, and what their kinds find. key: "robots[1].name"
void check_robot_items(const std::vector<RobotItem>& robots, std::vector<Diagnostic>& mistakes);

std::size_t count_lamps(const std::vector<RobotItem>& robots);
// The names that robots go by, in their order.
std::vector<std::string> robot_names(const std::vector<RobotItem>& robots);

}  // namespace rubble
