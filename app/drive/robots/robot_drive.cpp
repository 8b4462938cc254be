#include "app/drive/robots/robot_drive.h"

#include <algorithm>
#include <filesystem>

#include "app/control/robot_control.h"
#include "app/robots/ride_recorder.h"
#include "kernel/base/error.h"

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

RobotDrive::RobotDrive(const ResolvedMission& mission, const PileState& pile, const std::string& name,
                       RunContext& context)
    : scenario_(mission.scenario),
      assets_(mission.assets),
      pile_(pile),
      laid_(make_laid_pile(mission, pile)),
      folders_(robot_folders(mission)),
      threads_(context.threads()),
      names_(robot_names(mission.scenario.robots)),
      made_(make_robots(mission, context)),
      driven_(find_name(names_, name)) {
  for (std::size_t i = 0; i < names_.size(); ++i) {
    seen_.models.push_back(made_[i].model);
    if (i == driven_ || scenario_.robots[i].control == 0) continue;
    throw InputError({"", 0, "robots[" + std::to_string(i + 1) + "].control",
                      "a controller function cannot run during a drive", "`drive`, or a mission without this robot",
                      "a function", "--robot " + names_[i] + " drives this one"});
  }
  ride_ = scenario_.trajectory.ride;
  if (!ride_.on()) {
    ride_.robot = names_[driven_];
    ride_.link = seen_.models[driven_].links[seen_.models[driven_].lead()].name;
    ride_.position = kBehind, ride_.rpy_deg = kNoseDown;
  }
  rig_robot_ = find_name(names_, ride_.robot);
  link_from_rig_ = ride_.link_from_rig();
  const RiddenLink ridden = find_link(made_[rig_robot_], ride_.link, "trajectory.ride");
  rig_link_ = ridden.link;
  link_from_rig_ = ridden.link_from_rider * link_from_rig_;
  restart();
}

RobotController RobotDrive::controller_of(std::size_t robot) {
  return [this, robot, control = motions_of(robot)](const RobotSense& sense) {
    if (sensors_) sensors_->note(robot, sense);
    return control(sense);
  };
}

RobotController RobotDrive::motions_of(std::size_t robot) {
  if (robot != driven_)
    return with_mimics(make_leg_controller(scenario_.robots[robot], made_[robot].model), made_[robot].model.mimics);
  const RobotController follow = [this](const RobotSense& sense) {
    std::vector<RobotLeg>& legs = kept_;
    RobotWish wish = wish_;
    if (!courses_.empty()) courses_.ask(sense.time, wish);
    const RobotLeg leg = make_leg(wish, item_, legs.back(), sense.time, sense.time - asked_at_);
    asked_at_ = sense.time;
    if (!same_command(leg, legs.back())) {
      if (leg.t <= legs.back().t) legs.pop_back();
      legs.push_back(leg);
    }
    // As the mission that is kept will say it: by the last of them.
    item_.drive = {legs.back()};
    return make_leg_controller(item_, made_[driven_].model)(sense);
  };
  return with_mimics(follow, made_[robot].model.mimics);
}

void RobotDrive::restart() {
  item_ = scenario_.robots[driven_];
  item_.control = 0;
  item_.senses.clear();
  RobotLeg still;
  still.rate = 0;
  if (!item_.drive.empty()) still.gait = item_.drive.front().gait;
  kept_ = {still};
  asked_at_ = 0;
  courses_.end();
  run_ = std::make_unique<RobotRun>(laid_, pile_, robot_run_options(scenario_, threads_));
  seen_.first_piece.clear();
  for (std::size_t i = 0; i < made_.size(); ++i) {
    run_->add(made_[i].model, calc_base_pose(scenario_.robots[i], made_[i]), controller_of(i));
    seen_.first_piece.push_back(run_->world().robot_piece(int(i)));
  }
  run_->begin();
  if (sensors_) sensors_->restart(run_->world());
}

void RobotDrive::sense(const Scene& scene, const Medium& medium) {
  const auto find_mount = [&](const Carrier& ride, const std::string& key) {
    return find_link_mount(ride, LinkMount{rig_robot_, rig_link_, link_from_rig_}, key, names_, made_);
  };
  std::vector<RidingSensor> lidars, imus;
  for (const LidarScenario& lidar : scenario_.lidars)
    lidars.push_back({lidars.size(), find_mount(lidar.ride, "lidars." + lidar.name)});
  for (const ImuScenario& imu : all_imus(scenario_))
    imus.push_back({imus.size(), find_mount(imu.ride, scenario_.imus.empty() ? "imu" : "imus." + imu.name)});
  const double step = robot_run_options(scenario_, threads_).step;
  sensors_ = std::make_unique<LiveSensors>(
      scenario_, made_,
      std::make_unique<LiveRanges>(scenario_, lidars, std::vector<RidingSensor>(), scene, medium, step, threads_),
      std::make_unique<LiveImus>(scenario_, imus, step));
  sensors_->restart(run_->world());
}

std::vector<Sample> RobotDrive::take_sensed() {
  if (!sensors_) return {};
  return sensors_->take();
}

std::vector<RobotRecord> RobotDrive::records() const { return describe_robots(scenario_, made_); }

RigMount RobotDrive::mount() const { return {records()[rig_robot_].frame_of(int(rig_link_)), link_from_rig_}; }

void RobotDrive::follow(const JointTrajectoryCommand& trajectory) {
  const double time = double(run_->steps()) * robot_run_options(scenario_, threads_).step;
  courses_.begin(trajectory, made_[driven_].model, run_->world().robot_state(int(driven_)), time);
}

void RobotDrive::advance(const RobotWish& wish, double time) {
  wish_ = wish;
  const double step = robot_run_options(scenario_, threads_).step;
  const auto steps = std::int64_t(time / step + 0.5);
  while (run_->steps() < steps) {
    run_->step();
    if (sensors_) sensors_->note_step(run_->world());
  }
}

Pose RobotDrive::world_from_rig() const {
  return run_->world().robot_state(int(rig_robot_)).links[rig_link_].world_from_link * link_from_rig_;
}

Scene RobotDrive::build_scene(const Scenario& drawn) const {
  return build_live_scene(drawn, assets_, pile_, seen_, [this](int id, std::int64_t stamp_ns) -> std::optional<Pose> {
    if (sensors_ && sensors_->ranges().measuring()) return sensors_->ranges().pose_of(id, stamp_ns);
    const PieceState piece = run_->world().piece(id);
    if (piece.status == PieceStatus::lost) return std::nullopt;
    return piece.world_from_body;
  });
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
  kept.robots[driven_] = item_;
  kept.robots[driven_].urdf = urdf;
  kept.robots[driven_].drive = kept_;
  kept.trajectory = {};
  kept.trajectory.rate_hz = camera.trajectory.rate_hz;
  kept.trajectory.ride = ride_;
  const double step = robot_run_options(scenario_, threads_).step;
  kept.robot_run.duration = double(std::max<std::int64_t>(1, run_->steps())) * step;
  return kept;
}

RobotRunResult RobotDrive::finish() { return run_->finish(); }

}  // namespace rubble
