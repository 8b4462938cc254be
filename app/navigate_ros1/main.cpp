// ros1_navigator: MRPT's reactive navigator as a node of ROS 1. It drives a robot that it knows by topics alone, and ends
// with a report as JSON.

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/navigate_ros1/topic_navigator.h"
#include "app/support/print.h"
#include "app/support/stop.h"
#include "io/base/atomic_file.h"
#include "io/live/ros1_robot.h"
#include "kernel/base/error.h"
#include "kernel/base/number_text.h"
#include "kernel/base/system/output_files.h"
#include "kernel/base/text.h"

namespace rubble {
namespace {

// What the program returns to its caller.
enum class Result { arrived = 0, did_not_arrive = 1, not_started = 2, stopped = 4 };

struct Request {
  std::vector<std::pair<double, double>> goals;
  std::string robot = "crawler", sensor = "cloud", pose = "odom", planner = "none", localize = "match";
  std::string topic;  // empty: /points or /scan
  double turn_share = 0;  // 0: of the robot
  std::string log;        // a file; empty: none
  TopicNavigatorOptions navigator;
  Ros1RobotOptions ros;
};

std::vector<std::string> robot_names() {
  std::vector<std::string> names;
  for (const RobotKindOfNavigator& kind : known_robots()) names.push_back(kind.name);
  return names;
}

void declare(CLI::App& program, Request& r) {
  const auto one_of = [](std::vector<std::string> names) { return CLI::IsMember(std::move(names)); };
  program.add_option("--goal", r.goals,
                     "ahead and to the left of where the robot starts; m. Several are driven to one after the other")
      ->required();
  program.add_option("--robot", r.robot, "its shape, and how it skids")->check(one_of(robot_names()))
      ->capture_default_str();
  program.add_option("--turn-share", r.turn_share,
                     "share of a turn that the robot makes of what its tracks or wheels would give")
      ->check(CLI::Range(0.05, 1.0));
  program.add_option("--sensor", r.sensor, "cloud: PointCloud2, scan: LaserScan")->check(one_of({"cloud", "scan"}))
      ->capture_default_str();
  program.add_option("--topic", r.topic, "of the clouds or scans (default: /points or /scan)");
  program.add_option("--pose", r.pose, "odom: nav_msgs/Odometry, turns scaled by the turn share; tf: /tf, as it is")
      ->check(one_of({"odom", "tf"}))->capture_default_str();
  program.add_option("--odom", r.ros.odometry, "topic of the odometry")->capture_default_str();
  program.add_option("--fixed-frame", r.navigator.fixed_frame, "with --pose tf: poses are in it")->capture_default_str();
  program.add_option("--base-frame", r.navigator.base_frame, "with --pose tf: of the robot")->capture_default_str();
  program.add_option("--localize", r.localize, "match: poses are corrected by scans; none: they are believed")
      ->check(one_of({"match", "none"}))->capture_default_str();
  program.add_option("--planner", r.planner, "ompl: RRT* over the robot's own map gives the navigator places to drive to")
      ->check(one_of({"none", "ompl"}))->capture_default_str();
  program.add_option("--cmd-vel", r.ros.velocity, "topic of the velocities")->capture_default_str();
  program.add_option("--time-limit", r.navigator.time_limit, "of the robot's time; s")->check(CLI::Range(1.0, 86400.0))
      ->capture_default_str();
  program.add_option("--wait", r.navigator.wait, "for the first messages; s")->check(CLI::Range(1.0, 86400.0))
      ->capture_default_str();
  program.add_option("--log", r.log, "a CSV file that gets a row for each period");
  program.add_option("--ros-master", r.ros.ros.master, "the master (default: $ROS_MASTER_URI, or http://localhost:11311)");
  program.add_option("--ros-ip", r.ros.ros.address, "address by which other machines reach this program");
}

void complete(Request& r) {
  for (const RobotKindOfNavigator& kind : known_robots())
    if (kind.name == r.robot) r.navigator.robot = kind;
  if (r.turn_share > 0) r.navigator.robot.turn_share = r.turn_share;
  r.navigator.waypoints.clear();
  for (const auto& [x, y] : r.goals) {
    if (!(std::fabs(x) <= 50 && std::fabs(y) <= 50))
      throw InputError({"", 0, "--goal", "too far", "at most 50 m ahead and aside",
                        plain_text(x) + " " + plain_text(y), ""});
    r.navigator.waypoints.push_back({x, y, 0});
  }
  const std::filesystem::path folder = std::filesystem::path(r.log).parent_path();
  if (!folder.empty() && !std::filesystem::is_directory(folder))
    throw InputError({"", 0, "--log", "its folder is not there", "a file in a folder that is there", r.log, ""});
  r.navigator.planar = r.sensor == "scan";
  r.navigator.pose = r.pose == "tf" ? PoseSource::transforms : PoseSource::odometry;
  r.navigator.matches = r.localize == "match";
  r.navigator.plans = r.planner == "ompl";
  if (r.navigator.planar) r.ros.scan = "/scan", r.ros.cloud.clear();
  if (!r.topic.empty()) (r.navigator.planar ? r.ros.scan : r.ros.cloud) = r.topic;
  r.ros.ros.node = "ros1_navigator";
  r.ros.ros.notice = [](const std::string& text) { print_err("ros1_navigator: %s\n", text.c_str()); };
}

// A folder of its own, gone when this goes.
struct ArcsFolder {
  std::string path = rubble::make_private_folder(std::filesystem::temp_directory_path().string(), "ros1_navigator");
  ~ArcsFolder() { rubble::remove_output_folder(path); }
};

double wall() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

double rounded(double value, double to = 1000) { return std::round(value * to) / to; }

nlohmann::ordered_json to_json(const TopicReport& r) {
  nlohmann::ordered_json json;
  json["result"] = name_of(r.end);
  if (!r.message.empty()) json["message"] = r.message;
  json["left_m"] = rounded(r.left);
  json["x_m"] = rounded(r.pose.x), json["y_m"] = rounded(r.pose.y), json["yaw_rad"] = rounded(r.pose.yaw);
  json["way_m"] = rounded(r.way);
  json["simulated_s"] = rounded(r.time), json["wall_s"] = rounded(r.wall);
  json["real_time_factor"] = r.wall > 0 ? rounded(r.time / r.wall) : 0;
  json["periods"] = r.periods, json["deadlines_missed"] = r.deadlines_missed;
  json["slowest_ms"] = rounded(1000 * r.slowest, 10);
  json["clouds"] = r.clouds, json["clouds_dropped"] = r.clouds_dropped, json["clouds_late"] = r.clouds_late;
  json["clouds_empty"] = r.clouds_empty, json["points_left_out"] = r.points_left_out;
  json["poses"] = r.poses, json["matches_failed"] = r.matches_failed;
  json["plans"] = r.plans, json["plans_failed"] = r.plans_failed;
  return json;
}

void write_log(const std::string& path, const TopicReport& report) {
  std::string text = "stamp_s,x_m,y_m,yaw_rad,odometry_x_m,odometry_y_m,odometry_yaw_rad,slope_x,slope_y,ground_m,"
                     "linear,angular,took_ms\n";
  for (const TopicPeriod& p : report.course) {
    char row[300];
    std::snprintf(row, sizeof row, "%.3f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.2f\n",
                  1e-9 * double(p.stamp_ns), p.pose.x, p.pose.y, p.pose.yaw, p.odometry.x, p.odometry.y,
                  p.odometry.yaw, p.ground.along_x, p.ground.along_y, p.ground.height, p.linear, p.angular,
                  1000 * p.took);
    text += row;
  }
  write_text_file(path, text);
}

Result navigate_over_topics(Request& request) {
  complete(request);
  stop_on_signals();
  check_ros1(request.ros.ros);
  const ArcsFolder arcs;
  request.navigator.cache_folder = arcs.path;
  Ros1Robot robot(request.ros);
  TopicNavigator navigator(request.navigator, [&](double linear, double angular) { robot.drive(linear, angular); });
  while (!navigator.has_ended()) {
    navigator.hear(robot.take(0.02), wall());
    if (stop_requested()) navigator.end(TopicEnd::stopped, "a signal stopped this program");
  }
  const TopicReport& report = navigator.report();
  print_json(to_json(report).dump(2) + "\n");
  std::fflush(stdout);
  if (!request.log.empty()) write_log(request.log, report);
  if (!report.message.empty())
    print_err("ros1_navigator: %s: %s\n", name_of(report.end).c_str(), report.message.c_str());
  if (report.end == TopicEnd::stopped) return Result::stopped;
  return report.end == TopicEnd::arrived ? Result::arrived : Result::did_not_arrive;
}

}  // namespace
}  // namespace rubble

int main(int argc, char** argv) {
  rubble::Request request;
  CLI::App program("Drives a robot to a goal by MRPT's reactive navigator, over topics of ROS 1 alone (docs/explanation/autonomy.md).",
                   "ros1_navigator");
  program.footer("Exit codes: 0 arrived, 1 did not arrive, 2 could not start (options, no ROS master), "
                 "4 stopped by a signal.");
  rubble::declare(program, request);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? int(rubble::Result::arrived) : int(rubble::Result::not_started);
  }
  try {
    return int(rubble::navigate_over_topics(request));
  } catch (const std::exception& error) {
    rubble::print_err("ros1_navigator: %s\n", error.what());
  }
  return int(rubble::Result::not_started);
}
