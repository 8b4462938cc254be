// The robots of a mission: which, where, and how they are driven.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kernel/base/error.h"
#include "kernel/base/math.h"
#include "scripting/trajectory/trajectory.h"

namespace rubble {

enum class RobotKind { snake, crawler, rover, vine };
enum class GaitKind { lateral_undulation, sidewinding, rolling, serpenoid, helical_rolling };

// How a robot is driven from a time on.
struct RobotLeg {
  double t = 0;       // since the start; unit: s; range: 0 to 86400
  double linear = 0;  // of crawler and rover, forwards; unit: m/s; range: -5 to 5
  double angular = 0; // counter-clockwise; unit: rad/s; range: -10 to 10
  // Of a crawler: front left, front right, rear left, rear right; empty: as they stood.
  std::vector<double> flippers_deg{};
  GaitKind gait = GaitKind::sidewinding;  // of a snake
  double rate = 4;          // of its waves; negative: backwards; unit: rad/s; range: -20 to 20
  double phase = 0;         // of its waves, beside rate * t; unit: rad; range: -1e6 to 1e6
  double amplitude = 1;     // of the gait's own; unit: 1; range: 0 to 2
  double steering_deg = 0;  // added to the sideways joints; range: -45 to 45
  std::vector<double> joints{};  // positions of motors, beside the rest; unit: rad, slider m
  std::vector<std::string> joint_names{};  // whose they are; empty: all motors, in their order
  double growth = 0;        // of a vine's tip; unit: m/s; negative: it retracts; range: -1 to 1
  double curvature = 0, curvature_up = 0;  // of what grows, to the left and upwards; unit: 1/m; range: -5 to 5
};

// A lamp of a robot.
struct LampItem {
  std::string link{};               // empty: that of the model's headlamp
  std::optional<Vec3> position{};   // on the link; not given: the headlamp; unit: m
  Vec3 rpy_deg;                     // of its beam, from the link's X
  double intensity_cd = 100;        // on its axis; range: 0 to 100000
  double cone_deg = 70;             // full angle; range: 1 to 170
};

struct RobotItem {
  RobotKind model = RobotKind::snake;
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
  // Of a robot from a file: the links around which tracks run, instead of driven wheels.
  std::vector<std::string> left_tracks{}, right_tracks{};
  double track_speed = 1;  // at most; unit: m/s; range: 0.01 to 20
  std::string name{};  // empty: the model's, numbered
  Vec3 position;       // of its base frame, in the world; unit: m
  Vec3 rpy_deg;        // R = Rz(yaw) Ry(pitch) Rx(roll)
  int modules = 16;    // of a snake; range: 2 to 64
  bool flippers = true;  // of a crawler
  // Of a vine: pressure above that outside; the tube, its greatest length, and of a link of its model.
  double pressure = 10e3;     // unit: Pa; range: above 0 to 1e6
  double radius = 0.05;       // unit: m; range: 0.01 to 0.3
  double length = 3;          // unit: m; range: above 0 to 100; at least a link
  double link_length = 0.05;  // unit: m; range: 0.02 to 0.5
  std::optional<double> friction{};  // against concrete; not given: the model's; range: 0 to 2
  double odometry_noise = 0;  // standard deviation of a side's way over one metre; unit: m; range: 0 to 0.1; 0: exact
  std::vector<LampItem> lamps{};     // that shine
  std::vector<RobotLeg> drive{};     // in rising order of t; empty: it stands still
  int control = 0;  // number of a function of the script that drives it instead; 0: none
  std::vector<std::string> senses{};  // sensors whose readings that function is told; see colour_sense()
};

enum class DebrisMotion { free, fixed };

// When and how the robots of a mission run.
struct RobotRunScenario {
  double duration = 10;     // unit: s; range: above 0, to 86400
  double control_hz = 60;   // range: 1 to 240
  DebrisMotion debris = DebrisMotion::free;
};

class Schema;
struct Scenario;

// at: what the keys begin with: "imu.", or nothing.
void add_ride_keys(Schema& keys, const std::string& at, Carrier& ride);
// The scenario must outlive the schema.
void add_robot_keys(Schema& keys, Scenario& scenario);
// How `senses` names the colours of a camera; its name alone is its depth.
inline std::string colour_sense(const std::string& camera) { return camera + ".rgb"; }
std::size_t count_lamps(const std::vector<RobotItem>& robots);
// The names that robots go by, in their order.
std::vector<std::string> robot_names(const std::vector<RobotItem>& robots);
void check_robots(const Scenario& scenario, std::vector<Diagnostic>& mistakes);

}  // namespace rubble
