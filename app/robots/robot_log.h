// What one robot senses while it is driven, kept at the rate of its control.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/robots/mission_robot.h"
#include "io/recording/recording.h"
#include "kernel/robot/odometry.h"
#include "kernel/robot/robot_run.h"
#include "render/scene/robot_sample.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

class RobotLog {
 public:
  // start_ns: the stamp of its time 0; noise: with the number of the robot. The model must outlive the log.
  RobotLog(const RobotModel& model, std::int64_t start_ns, const OdometryNoise& noise);

  void note(const RobotSense& sense);

  const std::vector<RobotSample>& samples() const { return samples_; }
  // Those since the last call, where they are not to be kept.
  std::vector<RobotSample> take_samples() {
    odometry_.clear();
    return std::exchange(samples_, {});
  }
  const std::vector<OdometryReading>& odometry() const { return odometry_; }  // none, or one a sample
  double mean_slip() const { return wheels_ ? wheels_->mean_slip() : 0; }

 private:
  const RobotModel* model_;
  int number_;
  std::int64_t start_ns_;
  std::optional<WheelOdometry> wheels_;
  std::vector<RobotSample> samples_;
  std::vector<OdometryReading> odometry_;
};

// A link of the robot that has the name of a sensor's frame, or of one that is always there; empty: none has.
std::string find_frame_clash(const Scenario& scenario, const MissionRobot& robot);

// The robots of a mission for recorders. Frames have the robot's name in front where there are several robots, or where
// find_frame_clash() finds one. Throws InputError for frames whose names are equal all the same.
std::vector<RobotRecord> describe_robots(const Scenario& scenario, const std::vector<MissionRobot>& made);

}  // namespace rubble
