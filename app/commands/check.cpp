// `rubble check`: resolves everything and runs nothing.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/assets/asset_library.h"
#include "app/command_line/command.h"
#include "app/command_line/common_options.h"
#include "app/control/robot_control.h"
#include "app/mission/resolved_mission.h"
#include "app/robots/mission_robot.h"
#include "app/support/print.h"
#include "scripting/mission.h"
#include "scripting/reference/schema_docs.h"

namespace rubble {
namespace {

using Json = nlohmann::ordered_json;

struct CheckRequest {
  RunRequest run;
  bool robots = false;  // --robots
};

Json json_of(const Vec3& v) { return {v.x, v.y, v.z}; }

// Null where there are no points.
Json json_of(const Aabb& box) { return box.empty() ? Json() : Json{json_of(box.min), json_of(box.max)}; }

const char* name_of(JointKind kind) {
  return kind == JointKind::weld ? "fixed" : kind == JointKind::slider ? "prismatic" : "revolute";
}

// Null: the joint has no such limit.
Json limit_of(double limit) { return std::abs(limit) < kNever ? Json(limit) : Json(); }

Json joints_of(const RobotModel& model) {
  Json joints = Json::array();
  for (const RobotJoint& joint : model.joints)
    joints.push_back({{"name", joint.name},
                      {"kind", name_of(joint.kind)},
                      {"parent", model.links[std::size_t(joint.parent)].name},
                      {"child", model.links[std::size_t(joint.child)].name},
                      {"lower", limit_of(joint.lower)},
                      {"upper", limit_of(joint.upper)},
                      {"effort", joint.motor.effort},
                      {"speed", joint.motor.speed}});
  return joints;
}

// The whole robot as one body: all joints at 0, in the frame of the first link of its file, which is its base or a link
// `world` that the base is fixed to.
Json whole_of(const MissionRobot& robot) {
  const RobotModel& model = robot.model;
  std::vector<Pose> first_from_links = calc_base_from_links(model, std::vector<double>(model.joints.size(), 0));
  for (Pose& pose : first_from_links) pose = robot.placed_from_base * pose;
  const double mass = model.mass();
  Vec3 centre;
  for (std::size_t i = 0; i < model.links.size(); ++i)
    centre += first_from_links[i] * model.links[i].centre_of_mass * (model.links[i].mass / mass);
  Mat3 inertia = Mat3::diagonal({0, 0, 0});
  Aabb collision, visual;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const RobotLink& link = model.links[i];
    const Mat3 turn = first_from_links[i].rotation.matrix();
    const Vec3 d = first_from_links[i] * link.centre_of_mass - centre;
    inertia = inertia + turn * link.inertia * turn.transposed() +
              Mat3::diagonal({dot(d, d), dot(d, d), dot(d, d)}) * link.mass +
              Mat3{{d * d.x, d * d.y, d * d.z}} * -link.mass;
    for (const ConvexPart& part : link.parts)
      for (const Vec3& p : part.points) collision.include(first_from_links[i] * p);
    for (const Vec3f& p : link.looks.positions) visual.include(first_from_links[i] * Vec3(p));
  }
  const Vec3 x = inertia.column(0), y = inertia.column(1), z = inertia.column(2);
  return {{"mass_kg", mass},
          {"centre_of_mass_m", json_of(centre)},
          {"inertia_kg_m2", {x.x, y.y, z.z, y.x, z.x, z.y}},
          {"collision_bounds_m", json_of(collision)},
          {"visual_bounds_m", json_of(visual)}};
}

Json json_of(const MissionRobot& robot) {
  Json json{{"name", robot.model.name}};
  json.update(whole_of(robot));
  json["links"] = Json::array();
  for (const RobotLink& link : robot.model.links)
    json["links"].push_back({{"name", link.name}, {"mass_kg", link.mass}, {"parts", link.parts.size()}});
  json["joints"] = joints_of(robot.model);
  json["warnings"] = robot.warnings;
  return json;
}

void print_robots(const std::string& script, const Mission& mission, const AssetLibrary& assets) {
  std::vector<std::string> folders{std::filesystem::path(script).parent_path().string()};
  folders.insert(folders.end(), assets.folders.begin(), assets.folders.end());
  MeshImporter importer;
  Json robots = Json::array();
  for (std::size_t i = 0; i < mission.scenario.robots.size(); ++i)
    robots.push_back(json_of(make_mission_robot(mission.scenario.robots[i], folders,
                                                "robots[" + std::to_string(i + 1) + "]", importer)));
  print_json(robots.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

ExitCode check_mission(const CheckRequest& check) {
  const RunRequest& request = check.run;
  const Mission mission = load_mission(request.mission, mission_options(request));
  for (const std::string& line : mission.printed) print_err("%s\n", line.c_str());
  const AssetLibrary assets = load_assets(mission, request.asset_packs);
  print_warnings(assets.warnings);
  check_robot_models(mission.scenario, assets, mission.script);
  if (check.robots)
    print_robots(request.mission, mission, assets);
  else
    print_json(scenario_to_json(mission.scenario) + "\n");
  return ExitCode::done;
}

Action declare_check(CommandLine& line) {
  const auto request = std::make_shared<CheckRequest>();
  add_mission_options(line, request->run);
  add_seed_option(line, request->run);
  line.add_flag("--robots", request->robots,
                "Print masses, sizes and joints of the robots instead, as JSON");
  line.add_print("--schema", mission_json_schema,
                 "Print a JSON Schema of every key of a mission instead");
  line.add_print("--annotations", lua_annotations,
                 "Print LuaCATS annotations instead, for the checks and completions of editors");
  return [request] { return check_mission(*request); };
}

}  // namespace

Command check_command() {
  return {"", "check", "Check a mission and print its complete scenario as JSON; run nothing", declare_check};
}

}  // namespace rubble
