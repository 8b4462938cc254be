// What was driven, as a mission: under unchanged lamp, air and pile, one pose for every frame.
//
// The trajectory is linear with a waypoint at the time of every frame, where it passes exactly
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
  // scenario: everything but the waypoints, adapted; its rate is that of the frames.
  explicit DriveLog(const Scenario& scenario);

  void add(const DrivenPose& pose);
  int frames() const { return int(poses_.size()); }
  // Of any frame, also of those to come.
  std::int64_t stamp_ns(int frame) const;
  // Of the camera in the world, as a run on the mission has it at that frame: known once the next
  // pose is, or at the end; unit: m/s
  Vec3 velocity(int frame) const;

  Scenario scenario() const;
  std::string mission(const std::string& comment) const;  // the script

 private:
  double time(int frame) const;  // unit: s

  Scenario scenario_;
  std::vector<DrivenPose> poses_;
};

}  // namespace rubble
