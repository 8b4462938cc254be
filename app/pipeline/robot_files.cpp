#include "app/pipeline/robot_files.h"

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "io/base/atomic_file.h"
#include "io/state/track_file.h"
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

// The stamp in s with nine digits after the point, from integers.
std::string stamp_text(std::int64_t start_ns, double time) {
  const std::int64_t ns = start_ns + std::int64_t(time * 1e9 + 0.5);
  char text[48];
  std::snprintf(text, sizeof text, "%lld.%09lld", static_cast<long long>(ns / 1'000'000'000),
                static_cast<long long>(ns % 1'000'000'000));
  return text;
}

// Every sample, whether or not the base moved.
std::string trajectory_text(const Track& track, int base, std::int64_t start_ns) {
  std::string text = "# stamp tx ty tz qx qy qz qw: the base frame in the world\n";
  const TrackBody* const body = track.find(base);
  for (std::size_t i = 0; body && i < track.times.size(); ++i) {
    const auto motion = track.motion_at(*body, track.times[i]);
    if (!motion) break;
    const Vec3& p = motion->world_from_body.translation;
    const Quat& q = motion->world_from_body.rotation;
    text += stamp_text(start_ns, track.times[i]);
    for (double number : {p.x, p.y, p.z, q.x, q.y, q.z, q.w}) text += " " + format_number(number);
    text += "\n";
  }
  return text;
}

std::string joints_text(const RobotModel& model, const JointLog& log, std::int64_t start_ns) {
  std::string text = "stamp";
  for (const RobotJoint& joint : model.joints) {
    if (joint.motor.effort <= 0) continue;
    for (const char* what : {"position", "speed", "torque"}) text += "," + joint.name + "_" + what;
  }
  text += "\n";
  for (std::size_t i = 0; i < log.times.size(); ++i) {
    text += stamp_text(start_ns, log.times[i]);
    for (std::size_t k = 0; k < model.joints.size(); ++k) {
      if (model.joints[k].motor.effort <= 0) continue;
      const RobotState::Joint& joint = log.joints[i][k];
      for (double number : {joint.position, joint.speed, joint.torque}) {
        text += "," + format_number(number);
      }
    }
    text += "\n";
  }
  return text;
}

}  // namespace

std::vector<std::string> robot_file_names(const std::vector<std::string>& robots) {
  std::vector<std::string> names{"robots/track.bin", "robots/robots.json"};
  for (const std::string& robot : robots) {
    names.push_back("robots/" + robot + ".txt");
    names.push_back("robots/" + robot + "_joints.csv");
  }
  return names;
}

void write_robot_files(const std::string& folder, const std::vector<std::string>& names,
                       const std::vector<RobotModel>& models, const RobotRunResult& result,
                       const std::vector<JointLog>& joints, std::int64_t start_ns) {
  std::error_code failed;  // what follows says so
  std::filesystem::create_directories(folder + "/robots", failed);
  save_track(result.track, folder + "/robots/track.bin");
  Json list = Json::array();
  for (std::size_t i = 0; i < models.size(); ++i) {
    const std::string path = folder + "/robots/" + names[i];
    list.push_back(describe_robot(names[i], models[i], result.first_piece[i], result.robots[i]));
    write_text_file(path + ".txt", trajectory_text(result.track, result.first_piece[i], start_ns));
    write_text_file(path + "_joints.csv", joints_text(models[i], joints[i], start_ns));
  }
  const Json all = {{"format", "rubble robots 1"},
                    {"pieces_moved", result.pieces_moved},
                    {"robots", list}};
  write_text_file(folder + "/robots/robots.json", all.dump(2) + "\n");
}

}  // namespace rubble
