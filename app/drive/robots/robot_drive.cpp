#include "app/drive/robots/robot_drive.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "app/control/robot_control.h"
#include "kernel/base/error.h"
#include "kernel/world/world_robots.h"

namespace rubble {
namespace {

// Of the camera, where the mission lets it ride nowhere: behind and above a robot.
const Vec3 kBehind{-1.1, 0, 0.75}, kNoseDown{0, 22, 0};

std::size_t find_name(const std::vector<std::string>& names, const std::string& name) {
  if (name.empty()) return 0;
  const auto at = std::find(names.begin(), names.end(), name);
  if (at != names.end()) return std::size_t(at - names.begin());
  std::string all;
  for (const std::string& other : names) all += (all.empty() ? "one of " : ", ") + other;
  throw InputError({"", 0, "--robot", "no robot has this name", all, "\"" + name + "\"", ""});
}

}  // namespace

RobotDrive::RobotDrive(ResolvedMission mission, const PileState& pile, const std::string& name, RunContext& context)
    : mission_(std::move(mission)),
      folders_(robot_folders(mission_)),
      driven_(find_name(robot_names(mission_.scenario.robots), name)) {
  Scenario& scenario = mission_.scenario;
  const std::vector<std::string> names = robot_names(scenario.robots);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i == driven_ || scenario.robots[i].control == 0) continue;
    throw InputError({"", 0, "robots[" + std::to_string(i + 1) + "].control",
                      "a controller function cannot run during a drive", "`drive`, or a mission without this robot",
                      "a function", "--robot " + names[i] + " drives this one"});
  }
  scenario.robots[driven_].control = 0;
  scenario.robots[driven_].senses.clear();
  Ride& ride = scenario.trajectory.ride;
  std::vector<MissionRobot> made = make_robots(mission_, context);
  SessionOptions options;
  options.observed = context.options.live.ros1 || context.options.live.ros2;
  if (!ride.on()) {
    const RobotModel& model = made[driven_].model;
    ride.robot = names[driven_];
    ride.link = model.links[model.lead()].name;
    ride.position = kBehind, ride.rpy_deg = kNoseDown;
  }
  session_ = std::make_unique<Session>(mission_, pile, std::move(made), context, options);
  session_->set_controller(driven_, [this](const RobotSense& sense) {
    return robot_->control(sense, session_->robots()[driven_].model);
  });
  restart();
}

void RobotDrive::restart() {
  robot_ = std::make_unique<TeleopRobot>(mission_.scenario.robots[driven_]);
  session_->start();
}

void RobotDrive::follow(const JointTrajectoryCommand& trajectory) {
  robot_->follow(trajectory, session_->robots()[driven_].model, session_->world().robots().state(int(driven_)),
                 double(session_->steps()) * session_->step_time());
}

void RobotDrive::advance(const TeleopCommand& asked, double time) {
  robot_->ask(asked);
  const auto steps = std::int64_t(time / session_->step_time() + 0.5);
  while (session_->steps() < steps) session_->step();
}

Scenario RobotDrive::scenario(const Scenario& camera) const {
  Scenario kept = camera;
  // The mission that is kept lies elsewhere.
  for (RobotItem& robot : kept.robots) {
    for (const std::string& folder : folders_) {
      if (robot.urdf.empty()) break;
      std::error_code failed;
      const std::filesystem::path beside = std::filesystem::absolute(std::filesystem::path(folder) / robot.urdf);
      if (!std::filesystem::is_regular_file(beside, failed)) continue;
      robot.urdf = beside.string();
      break;
    }
  }
  const std::string urdf = kept.robots[driven_].urdf;
  kept.robots[driven_] = robot_->item();
  kept.robots[driven_].urdf = urdf;
  kept.robots[driven_].drive = robot_->legs();
  kept.trajectory = {};
  kept.trajectory.rate_hz = camera.trajectory.rate_hz;
  kept.trajectory.ride = mission_.scenario.trajectory.ride;
  kept.robot_run.live_light = true;  // as it was drawn
  kept.robot_run.duration = double(std::max<std::int64_t>(1, session_->steps())) * session_->step_time();
  return kept;
}

}  // namespace rubble
