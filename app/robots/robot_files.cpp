#include "app/robots/robot_files.h"

#include <nlohmann/json.hpp>

#include "io/base/atomic_file.h"
#include "io/base/escaped_text.h"
#include "io/robot/urdf_writer.h"
#include "io/mesh/stl_writer.h"
#include "io/scenes/scene_text.h"
#include "io/state/track_file.h"
#include "kernel/base/number_text.h"
#include "kernel/base/system/output_files.h"
#include "kernel/geometry/hull.h"
#include "kernel/robot/parts.h"
#include "scripting/values/value.h"

namespace rubble {
namespace {

using Json = nlohmann::ordered_json;

Json describe_robot(const std::string& name, const RobotModel& model, int first_piece,
                    const RobotSummary& summary) {
  Json links = Json::array(), joints = Json::array();
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    links.push_back({{"name", model.links[i].name},
                     {"id", first_piece + int(i)},
                     {"mass_kg", model.links[i].mass}});
  }
  for (const RobotJoint& joint : model.joints) {
    joints.push_back({{"name", joint.name},
                      {"parent", model.links[std::size_t(joint.parent)].name},
                      {"child", model.links[std::size_t(joint.child)].name},
                      {"driven", joint.motor.effort > 0}});
  }
  return {{"name", name},
          {"model", model.name},
          {"mass_kg", model.mass()},
          {"links", links},
          {"joints", joints},
          {"distance_m", summary.distance},
          {"path_m", summary.path},
          {"work_j", summary.work},
          {"lowest_m", summary.lowest},
          {"stuck_s", summary.stuck_time},
          {"lost", summary.lost}};
}

// Every sample, whether or not the base moved.
std::string trajectory_text(const Track& track, const std::string& frame, int base, std::int64_t start_ns) {
  std::string text = "# stamp tx ty tz qx qy qz qw: " + frame + " in the world\n";
  const TrackBody* const body = track.find(base);
  for (std::size_t i = 0; body && i < track.times.size(); ++i) {
    const auto motion = track.motion_at(*body, track.times[i]);
    if (!motion) break;
    const Vec3& p = motion->world_from_body.translation;
    const Quat& q = motion->world_from_body.rotation;
    text += seconds_text(start_ns + std::int64_t(track.times[i] * 1e9 + 0.5));
    for (double number : {p.x, p.y, p.z, q.x, q.y, q.z, q.w}) text += " " + exact_text(number);
    text += "\n";
  }
  return text;
}

std::string joints_text(const RobotModel& model, const RobotLog& log) {
  std::string text = "stamp";
  for (const RobotJoint& joint : model.joints) {
    if (joint.motor.effort <= 0) continue;
    for (const char* what : {"position", "speed", "torque"}) text += "," + csv_text(joint.name + "_" + what);
  }
  text += "\n";
  for (const RobotSample& sample : log.samples()) {
    text += seconds_text(sample.stamp_ns);
    for (std::size_t k = 0; k < model.joints.size(); ++k) {
      if (model.joints[k].motor.effort <= 0) continue;
      for (double number : {sample.positions[k], sample.speeds[k], sample.efforts[k]}) {
        text += "," + exact_text(number);
      }
    }
    text += "\n";
  }
  return text;
}

std::string odometry_text(const RobotLog& log) {
  std::string text =
      "stamp,x,y,yaw,linear,angular,true_linear,true_angular,left,right,slip_left,slip_right\n";
  for (std::size_t i = 0; i < log.odometry().size(); ++i) {
    const OdometryReading& o = log.odometry()[i];
    text += seconds_text(log.samples()[i].stamp_ns);
    for (double number : {o.x, o.y, o.yaw, o.linear, o.angular, o.true_linear, o.true_angular, o.left,
                          o.right, o.slip_left(), o.slip_right()}) {
      text += "," + exact_text(number);
    }
    text += "\n";
  }
  return text;
}

// Makes the folder a package, so that ROS finds the meshes of /robot_description.
std::string package_text() {
  return std::string("<?xml version=\"1.0\"?>\n<package format=\"2\">\n  <name>") + kRobotsPackage +
         "</name>\n  <version>1.0.0</version>\n  <description>Robots of a run of Rubble</description>\n"
         "  <maintainer email=\"nobody@example.org\">nobody</maintainer>\n  <license>unknown</license>\n</package>\n";
}

}  // namespace

void write_robot_description(const std::string& folder, const std::string& name, const RobotModel& model) {
  const std::string meshes = name + "_meshes";
  make_folder_below(folder, meshes);
  for (const RobotLink& link : model.links) {
    if (link.parts.empty() && link.looks.triangles.empty()) continue;
    write_text_file(folder + "/" + link_mesh_file(meshes, link.name), stl_bytes(make_link_mesh(link, "")));
    for (std::size_t k = 0; k < link.parts.size(); ++k)
      write_text_file(folder + "/" + part_mesh_file(meshes, link.name, k), hull_obj(calc_hull(link.parts[k].points)));
  }
  write_text_file(folder + "/" + name + ".urdf", robot_to_urdf(model, name, meshes));
}

std::vector<std::string> robot_file_names(const std::vector<std::string>& robots,
                                          const std::vector<RobotModel>& models) {
  std::vector<std::string> names{"robots/track.bin", "robots/robots.json", "robots/package.xml"};
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const std::string own = "robots/" + robots[i];
    names.insert(names.end(), {own + ".txt", own + "_joints.csv", own + ".urdf", own + "_meshes"});
    if (models[i].sides.any()) names.push_back(own + "_odometry.csv");
  }
  return names;
}

void write_robot_files(const std::string& folder, const std::vector<std::string>& names,
                       const RobotTrack& moved, const std::vector<RobotSummary>& summaries, int pieces_moved,
                       const std::vector<RobotLog>& logs, std::int64_t start_ns) {
  const std::vector<RobotModel>& models = moved.models;
  make_folder_below(folder, "robots");
  save_track(moved.track, folder + "/robots/track.bin");
  Json list = Json::array();
  for (std::size_t i = 0; i < models.size(); ++i) {
    const std::string path = folder + "/robots/" + names[i];
    list.push_back(describe_robot(names[i], models[i], moved.first_piece[i], summaries[i]));
    const int lead = moved.first_piece[i] + int(models[i].lead());
    const std::string frame = models[i].tube ? "the frame of the tip" : "the base frame";
    write_text_file(path + ".txt", trajectory_text(moved.track, frame, lead, start_ns));
    write_text_file(path + "_joints.csv", joints_text(models[i], logs[i]));
    if (models[i].sides.any()) write_text_file(path + "_odometry.csv", odometry_text(logs[i]));
    write_robot_description(folder + "/robots", names[i], models[i]);
  }
  const Json all = {{"format", "rubble robots 1"},
                    {"pieces_moved", pieces_moved},
                    {"robots", list}};
  write_text_file(folder + "/robots/robots.json", all.dump(2) + "\n");
  write_text_file(folder + "/robots/package.xml", package_text());
}

}  // namespace rubble
