// One robot of a mission driven live, among the others, which follow the mission. What was asked of it is kept as
// the commands of a mission, whose run has the same bits.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/drive/robots/joint_courses.h"
#include "app/drive/robots/live_sensors.h"
#include "app/drive/robots/robot_wish.h"
#include "app/mission/resolved_mission.h"
#include "app/robots/mission_robot.h"
#include "app/scene/moving_scene.h"
#include "kernel/robot/robot_run.h"

namespace rubble {

class RobotDrive {
 public:
  // name: of the robot that is driven; empty: the first. Throws InputError: no such robot, another robot is driven
  // by a function, the camera rides on a link that is not there.
  RobotDrive(const ResolvedMission& mission, const PileState& pile, const std::string& name, RunContext& context);

  // From the start again: what was driven so far is forgotten.
  void restart();
  // From now on its joints go by that besides what else is asked for. Throws InputError, and goes on as before, for
  // one that this robot cannot follow: see JointCourses::begin().
  void follow(const JointTrajectoryCommand& trajectory);
  // So that the world's time is `time` since the start; unit: s
  void advance(const RobotWish& wish, double time);

  Pose world_from_rig() const;  // of the camera: as trajectory.ride says, else behind the driven robot
  // The scene with the robots where they are when it is drawn. It must not outlive this.
  Scene build_scene(const Scenario& drawn) const;

  // From now on notes what is sensed. scene: as build_scene() makes it.
  void sense(const Scene& scene, const Medium& medium);
  // What was sensed since the last call; nothing before sense().
  std::vector<Sample> take_sensed();
  // The robots for recorders, and what carries the camera.
  std::vector<RobotRecord> records() const;
  RigMount mount() const;

  const std::string& name() const { return names_[driven_]; }
  // The mission that does the same again. camera: everything but robots and their run.
  Scenario scenario(const Scenario& camera) const;
  // What moved so far; afterwards there is only restart().
  RobotRunResult finish();

 private:
  RobotController controller_of(std::size_t robot);
  RobotController motions_of(std::size_t robot);

  const Scenario scenario_;
  const AssetLibrary& assets_;
  const PileState& pile_;
  Pile laid_;
  std::vector<std::string> folders_;  // of URDF files
  int threads_;
  std::vector<std::string> names_;
  std::vector<MissionRobot> made_;
  std::size_t driven_ = 0, rig_robot_ = 0, rig_link_ = 0;
  Ride ride_;
  Pose link_from_rig_;
  RobotItem item_;               // the driven one, with its last command
  std::vector<RobotLeg> kept_;   // all of its commands so far
  RobotWish wish_;
  JointCourses courses_;
  double asked_at_ = 0;  // of the last command; unit: s
  std::unique_ptr<RobotRun> run_;
  RobotTrack seen_;  // models and ids
  std::unique_ptr<LiveSensors> sensors_;
};

}  // namespace rubble
