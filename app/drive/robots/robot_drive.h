// One robot of a mission driven live, among the others, which follow the mission. What was asked of it is kept as
// the commands of a mission, whose run has the same bits.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/control/teleop_robot.h"
#include "app/mission/resolved_mission.h"
#include "app/session/session.h"
#include "scripting/robots/robot_kind.h"

namespace rubble {

class RobotDrive {
 public:
  // name: of the robot that is driven; empty: the first. What is sensed is noted where it is published. Throws InputError:
  // no such robot, another robot is driven by a function, the camera rides on a link that is not there.
  RobotDrive(ResolvedMission mission, const PileState& pile, const std::string& name, RunContext& context);

  // From the start again: what was driven so far is forgotten.
  void restart();
  // Of the next start, for what is sensed.
  void set_air(const AirSpec& air) { mission_.scenario.air = air; }
  // From now on its joints go by that besides what else is asked for. Throws InputError, and goes on as before, for
  // one that this robot cannot follow: see JointCourses::begin().
  void follow(const JointTrajectoryCommand& trajectory);
  // So that the world's time is `time` since the start; unit: s
  void advance(const TeleopCommand& asked, double time);

  // Of the camera: as trajectory.ride says, else behind the driven robot.
  Pose world_from_rig() const { return session_->world_from_rig(); }
  // The scene with the robots where they are when it is drawn. It must not outlive this.
  Scene build_scene(const Scenario& drawn) const { return session_->build_scene(drawn); }

  const World& world() const { return session_->world(); }
  // What was sensed since the last call.
  std::vector<Sample> take_sensed() { return session_->observe(); }
  // The robots for recorders, and what carries the camera.
  const std::vector<RobotRecord>& records() const { return session_->records(); }
  RigMount mount() const { return *session_->mount(); }

  const std::string& name() const { return session_->names()[driven_]; }
  // The mission that does the same again. camera: everything but robots and their run.
  Scenario scenario(const Scenario& camera) const;
  // What moved so far; afterwards there is only restart().
  Track finish() { return session_->finish().moved.track; }

 private:
  ResolvedMission mission_;
  std::vector<std::string> folders_;  // of URDF files
  std::size_t driven_ = 0;
  std::unique_ptr<TeleopRobot> robot_;  // the driven one
  std::unique_ptr<Session> session_;
};

}  // namespace rubble
