// Robots of a mission stepped through its settled pile: what they do, and what their sensors measure meanwhile.
//
// `rubble run`, `rubble drive` and the Python package step robots by this alone, so the same commands give the same poses,
// contacts and samples, bit for bit.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/mission/resolved_mission.h"
#include "app/robots/mission_robot.h"
#include "app/robots/robot_log.h"
#include "app/scene/moving_scene.h"
#include "app/session/driven_robots.h"
#include "app/session/pose_history.h"
#include "app/support/run_request.h"
#include "kernel/model/pile_state.h"
#include "kernel/robot/robot_run.h"
#include "render/scene/sample.h"

namespace rubble {

class LiveColours;
class RayWorld;
class RobotSenses;
class ScriptControl;
class Sensor;

// What is measured besides what the functions of robots are told, and when it starts.
struct SessionOptions {
  bool observed = false;  // robots and the sensors on them, for observe()
  bool depth = false;     // and the exact depth of the cameras on robots
  bool recorded = false;  // all is kept, for finish()
  bool restarts = false;  // start() is called more than once: the pile is laid the first time only
  std::optional<std::int64_t> start_ns{};  // stamp of the robots' time 0; not given: the mission's
};

class Session {
 public:
  // robots: by make_robots(). The mission, the pile and the context must outlive this. Throws InputError for what should
  // ride on a link that is not there.
  Session(const ResolvedMission& mission, const PileState& pile, std::vector<MissionRobot> robots, RunContext& context,
          const SessionOptions& options = {});
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  // Instead of what the mission says, from the next start() on.
  void set_controller(std::size_t robot, RobotController controller);
  // The pose of its first link instead of the mission's, from the next start() on; nothing: as the mission says again.
  void place(std::size_t robot, const std::optional<Pose>& world_from_base) { bases_[robot] = world_from_base; }
  // Instead of what its controller says, from its next control step on; nothing: as the controller says again. Joints that
  // mimic others follow.
  void command(std::size_t robot, std::optional<RobotCommand> command) { commands_[robot] = std::move(command); }
  // At the robots' time 0; what was before is forgotten. Throws InputError for a sensor that a function senses and no
  // robot carries, RunError where colours are sensed and there is no OpenGL.
  void start();
  // Throws InputError as RobotRun does, and as functions do.
  void step();
  // All samples since the last call, in order of their stamps. Each comes two steps after it is complete, and not
  // before the next sample of the track.
  std::vector<Sample> observe();
  // The last readings, and what a recording needs. Afterwards there is only start().
  DrivenRobots finish();

  const std::vector<std::string>& names() const { return names_; }
  const std::vector<MissionRobot>& robots() const { return robots_; }
  const std::vector<RobotLog>& logs() const { return logs_; }
  const std::vector<RobotRecord>& records() const { return records_; }
  std::optional<RigMount> mount() const { return history_.mount(records_); }
  const World& world() const { return run_->world(); }
  std::int64_t steps() const { return run_->steps(); }  // since start()
  double step_time() const { return run_options_.step; }  // unit: s
  std::int64_t steps_of_mission() const;  // as many as robot_run.duration asks for
  Pose world_from_rig() const { return history_.world_from_rig(); }  // the rig must be on a robot
  // Now, of what carries a sensor; nothing: no robot does.
  std::optional<Pose> world_from(const Carrier& carrier) const { return history_.world_from(carrier); }
  // From outside, on a piece or a link, before the next step: see World::apply_impulse(). No mission says this again.
  void apply_impulse(int piece, const Vec3& point, const Vec3& impulse) { run_->apply_impulse(piece, point, impulse); }
  // Likewise: see World::set_pose() and World::set_velocity().
  void set_pose(int piece, const Pose& world_from_body) { run_->set_pose(piece, world_from_body); }
  void set_velocity(int piece, const Vec3& linear, const Vec3& angular) { run_->set_velocity(piece, linear, angular); }
  // Ways of what carries sensors so far, on to now: between the last two steps they may still change a little.
  const RobotReadings& ways() const { return history_.ways(); }
  // The scene with everything where it is when it is drawn. drawn: the scenario of the camera. It must not outlive this.
  Scene build_scene(const Scenario& drawn) const;

 private:
  RobotController make_controller(std::size_t robot);
  void make_sensors();
  // Of what the history knows by now.
  void measure();

  const ResolvedMission& mission_;
  const Scenario& scenario_;
  const PileState& pile_;
  RunContext& context_;
  SessionOptions options_;
  std::int64_t start_ns_;
  RobotRunOptions run_options_;
  Pile laid_;
  std::vector<std::string> names_;
  std::vector<MissionRobot> robots_;
  std::vector<RobotRecord> records_;
  PoseHistory history_;
  std::vector<RobotController> own_;  // none: as the mission says
  std::vector<std::optional<Pose>> bases_;
  std::vector<std::optional<RobotCommand>> commands_;
  RobotTrack seen_;                   // models and ids
  std::unique_ptr<RobotRun> run_;
  std::vector<RobotLog> logs_;
  std::unique_ptr<RobotSenses> senses_;
  std::unique_ptr<ScriptControl> script_;
  std::shared_ptr<RayWorld> world_of_rays_;
  std::unique_ptr<LiveColours> colours_;
  struct Carried {
    std::unique_ptr<Sensor> sensor;
    Carrier carrier;
    bool taken = false;  // whether it gave a sample
  };
  std::vector<Carried> sensors_;
  std::vector<Sample> measured_;  // for observe()
};

}  // namespace rubble
