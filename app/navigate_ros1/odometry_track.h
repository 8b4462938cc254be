// Where odometry says that the robot was, from where it was first heard of. Tracks and wheels that skid turn the robot by
// less than odometry says: each turn is scaled, and what was driven is laid along the headings that are left.
#pragma once

#include <cstdint>
#include <vector>

#include "app/navigate_ros1/planar_pose.h"

namespace rubble {

inline double seconds_of(std::int64_t ns) { return 1e-9 * double(ns); }

class OdometryTrack {
 public:
  // turn_share: of the turns of the poses that are heard, which the robot truly makes; 1: taken as they are.
  explicit OdometryTrack(double turn_share) : turn_share_(turn_share) {}

  // restarted: the stamp is before the last one, or no robot drives so far in that time. ignored: a stamp that was heard.
  enum class Heard { taken, ignored, restarted };
  Heard add(std::int64_t stamp_ns, const Pose& fixed_from_base);

  bool empty() const { return stamps_.empty(); }
  std::int64_t last_stamp() const { return stamps_.back(); }
  // In the frame of the first pose. at(): between two poses, and of the nearest one outside of them.
  const PlanarPose& last() const { return poses_.back(); }
  PlanarPose at(std::int64_t stamp_ns) const;
  // Of late, in the robot's own frame; unit: m/s, rad/s
  PlanarPose velocity() const;

 private:
  double turn_share_;
  PlanarPose heard_;  // the last one as it was heard
  std::vector<std::int64_t> stamps_;
  std::vector<PlanarPose> poses_;
};

}  // namespace rubble
