#include "app/navigate_ros1/odometry_track.h"

#include <algorithm>
#include <cmath>

namespace rubble {
namespace {

constexpr std::int64_t kOutOfOrder = 500'000'000;  // messages may come so late; more is another beginning; unit: ns
constexpr double kJump = 1, kFastest = 3;          // a robot is not farther away after no time, and not faster; unit: m, m/s
constexpr std::int64_t kLately = 150'000'000;      // velocities are means of that; unit: ns

PlanarPose seen_from_above(const Pose& pose) {
  const Vec3 ahead = pose.rotation.rotate({1, 0, 0});
  return {pose.translation.x, pose.translation.y, portable::atan2(ahead.y, ahead.x)};
}

}  // namespace

OdometryTrack::Heard OdometryTrack::add(std::int64_t stamp_ns, const Pose& fixed_from_base) {
  const PlanarPose heard = seen_from_above(fixed_from_base);
  if (empty()) {
    heard_ = heard;
    stamps_.push_back(stamp_ns), poses_.push_back({});
    return Heard::taken;
  }
  if (stamp_ns <= last_stamp()) return last_stamp() - stamp_ns > kOutOfOrder ? Heard::restarted : Heard::ignored;
  const double far = std::hypot(heard.x - heard_.x, heard.y - heard_.y);
  if (far > kJump + kFastest * seconds_of(stamp_ns - last_stamp())) return Heard::restarted;
  PlanarPose step = inverse(heard_) * heard;
  // The chord of an arc leaves it by half of its turn.
  const double turn = turn_share_ * step.yaw;
  step = PlanarPose{0, 0, 0.5 * (turn - step.yaw)} * step;
  step.yaw = turn;
  heard_ = heard;
  stamps_.push_back(stamp_ns), poses_.push_back(last() * step);
  return Heard::taken;
}

PlanarPose OdometryTrack::at(std::int64_t stamp_ns) const {
  const auto after = std::lower_bound(stamps_.begin(), stamps_.end(), stamp_ns);
  if (after == stamps_.begin()) return poses_.front();
  if (after == stamps_.end()) return poses_.back();
  const auto i = std::size_t(after - stamps_.begin());
  const PlanarPose &a = poses_[i - 1], &b = poses_[i];
  const double t = double(stamp_ns - stamps_[i - 1]) / double(stamps_[i] - stamps_[i - 1]);
  return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), wrapped(a.yaw + t * wrapped(b.yaw - a.yaw))};
}

PlanarPose OdometryTrack::velocity() const {
  if (stamps_.size() < 2) return {};
  const std::int64_t from = std::max(stamps_.front(), last_stamp() - kLately);
  const PlanarPose step = inverse(at(from)) * last();
  const double time = seconds_of(last_stamp() - from);
  return {step.x / time, step.y / time, step.yaw / time};
}

}  // namespace rubble
