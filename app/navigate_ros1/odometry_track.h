// Where odometry says that the robot was, from where it was first heard of. Tracks and wheels that skid turn the robot by
// less than odometry says: each turn is scaled, and what was driven is laid along the headings that are left.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/base/portable_math.h"

namespace rubble {

// Where something is on the ground, and which way it looks.
struct PlanarPose {
  double x = 0, y = 0, yaw = 0;  // unit: m, rad
};

// Into -pi to pi; range: |angle| <= 1e6.
inline double wrapped(double angle) { return portable::atan2(portable::sin(angle), portable::cos(angle)); }

// As Pose: a_from_b * b_from_c.
inline PlanarPose operator*(const PlanarPose& a, const PlanarPose& b) {
  const portable::SinCos t = portable::sincos(a.yaw);
  return {a.x + t.cos * b.x - t.sin * b.y, a.y + t.sin * b.x + t.cos * b.y, wrapped(a.yaw + b.yaw)};
}
inline PlanarPose inverse(const PlanarPose& a) {
  const portable::SinCos t = portable::sincos(a.yaw);
  return {-t.cos * a.x - t.sin * a.y, t.sin * a.x - t.cos * a.y, -a.yaw};
}
inline Vec3 operator*(const PlanarPose& a, const Vec3& p) {
  const portable::SinCos t = portable::sincos(a.yaw);
  return {a.x + t.cos * p.x - t.sin * p.y, a.y + t.sin * p.x + t.cos * p.y, p.z};
}

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
