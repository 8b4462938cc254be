// What was driven, as a mission: under unchanged lamp, air and pile, one pose for every step; every so many steps there is a
// frame.
//
// The trajectory is linear with a waypoint at the time of every step, where it passes exactly
// (scripting/trajectory/curves.h); so `rubble run` on the mission gives the poses that were seen, bit for bit.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/drive/driven_camera.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

// Takes out of a scenario what cannot be had while the way ahead is not known yet (rolling shutter,
// motion blur, flow, events, inertial unit), and the speed limits of a planned path. What was on is
// listed, in words.
std::vector<std::string> adapt_to_driving(Scenario& scenario);

class DriveLog {
 public:
  // scenario: everything but the waypoints, adapted; its rate is that of the frames. steps_per_frame: >= 1
  explicit DriveLog(const Scenario& scenario, int steps_per_frame = 1);

  void add(const DrivenPose& pose);  // of the next step
  int steps() const { return int(poses_.size()); }
  int frames() const { return (steps() + steps_per_frame_ - 1) / steps_per_frame_; }
  bool at_frame() const { return (steps() - 1) % steps_per_frame_ == 0; }  // whether the last step has one
  double time(int step) const;                                            // since the first; unit: s
  // Of any frame, also of those to come.
  std::int64_t stamp_ns(int frame) const;
  // Of the camera in the world, as a run on the mission has it at that frame: known once the next
  // pose is, or at the end; unit: m/s
  Vec3 velocity(int frame) const;

  Scenario scenario() const;
  std::string mission(const std::string& comment) const;  // the script

 private:
  Scenario scenario_;
  int steps_per_frame_;
  std::vector<DrivenPose> poses_;
};

}  // namespace rubble
