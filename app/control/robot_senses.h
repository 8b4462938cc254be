// What the functions that drive robots are told of LiDARs, cameras and inertial units: measured while the robots are
// driven.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "app/mission/resolved_mission.h"
#include "app/robots/live_colours.h"
#include "app/robots/live_imus.h"
#include "app/robots/live_ranges.h"
#include "app/robots/mission_robot.h"
#include "app/scene/moving_scene.h"
#include "app/support/run_context.h"
#include "kernel/model/pile_state.h"
#include "kernel/robot/robot_run.h"
#include "scripting/values/value.h"

namespace rubble {

class RobotSenses {
 public:
  // Measures what `senses` of the mission's robots name. All of these must outlive it. Throws InputError for a sensor
  // that no robot carries.
  RobotSenses(const ResolvedMission& mission, const PileState& pile, const std::vector<MissionRobot>& robots,
              RunContext& context);

  // Once all robots are added, before the first step. step: unit: s. Throws InputError for depth of a camera with a
  // lens, RunError where colours are asked for and there is no OpenGL.
  void begin(const RobotRun& run, double step);
  void note_step(const World& world);  // after each step
  // Adds `lidars`, `cameras`, `images` and `imus` to what the robot's function is told: what was measured since its
  // last call.
  void tell(std::size_t robot, Value& told);

 private:
  // What a robot has not been told yet.
  struct Untold {
    std::vector<std::shared_ptr<const LidarScan>> scans;
    std::vector<std::shared_ptr<const SensedDepth>> depths;
    std::vector<std::shared_ptr<const SensedColours>> colours;
    std::vector<ImuSample> readings;
  };
  bool senses(std::size_t robot, const std::string& name) const;
  bool sensed(const std::string& name) const;  // by any robot
  // While it measures, `measurer` says where things are; before, the world.
  template <typename Measurer>
  Scene build_scene(const World& world, const std::unique_ptr<Measurer>& measurer) const;
  void measure();

  const ResolvedMission& mission_;
  const PileState& pile_;
  RunContext& context_;
  std::vector<std::string> camera_names_, imu_names_;
  std::vector<RidingSensor> lidars_, depth_cameras_, colour_cameras_, imus_;  // that any robot senses
  std::vector<Untold> untold_;  // by robot
  RobotTrack seen_;             // models and ids
  std::unique_ptr<LiveRanges> ranges_;
  std::unique_ptr<LiveImus> readings_;
  std::unique_ptr<LiveColours> colours_;  // none: no robot senses colours
};

}  // namespace rubble
