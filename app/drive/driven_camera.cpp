#include "app/drive/driven_camera.h"

#include <algorithm>

#include "kernel/base/portable_math.h"

namespace rubble {
namespace {

constexpr double kDegree = portable::kPi / 180.0;
constexpr double kKept = 1e-3;      // room that is kept beyond the radius; unit: m
constexpr double kFineStep = 1e-3;  // near things the way is walked in steps of this; unit: m
constexpr double kLift = 1e-5;      // off the surface that is slid along; unit: m
constexpr int kMostSlides = 3;      // a corner has three faces

// No longer than that, in the same direction.
Vec3 bounded(const Vec3& asked, double most) {
  static constexpr double kSquarable = 1e150;
  const auto clip = [](double x) { return std::clamp(x, -kSquarable, kSquarable); };
  const Vec3 v{clip(asked.x), clip(asked.y), clip(asked.z)};
  const double length = norm(v);
  return length > most ? v * (most / length) : v;
}

Vec3 without_negative_zero(const Vec3& v) { return v + Vec3{}; }

}  // namespace

Pose DrivenPose::world_from_camera() const {
  return {portable::quat_from_rpy(rpy_deg.x * kDegree, rpy_deg.y * kDegree, rpy_deg.z * kDegree),
          position};
}

// From R = Rz(yaw) Ry(pitch) Rx(roll); straight up or down only roll - yaw or roll + yaw is known,
// and yaw is 0.
DrivenPose make_driven_pose(const Pose& world_from_camera) {
  const Mat3 r = normalized(world_from_camera.rotation).matrix();
  const double level = std::sqrt(r.rows[0].x * r.rows[0].x + r.rows[1].x * r.rows[1].x);
  const double pitch = portable::atan2(-r.rows[2].x, level);
  double roll = 0, yaw = 0;
  if (level > 1e-6) {
    roll = portable::atan2(r.rows[2].y, r.rows[2].z);
    yaw = portable::atan2(r.rows[1].x, r.rows[0].x);
  } else {
    roll = portable::atan2(pitch > 0 ? r.rows[0].y : -r.rows[0].y, r.rows[1].y);
  }
  return {without_negative_zero(world_from_camera.translation),
          without_negative_zero(Vec3(roll, pitch, yaw) * (1 / kDegree))};
}

DrivenCamera::DrivenCamera(const DrivenPose& start, Plan plan, double radius,
                           const PileQueries& queries, const DriveLimits& limits)
    : pose_(start),
      plan_(plan),
      radius_(radius),
      queries_(&queries),
      limits_(limits),
      speed_(std::clamp(limits.speed, limits.least_speed, limits.most_speed)) {}

void DrivenCamera::change_speed(int notches) {
  for (; notches > 0; --notches) speed_ *= 1.25;
  for (; notches < 0; ++notches) speed_ *= 0.8;
  speed_ = std::clamp(speed_, limits_.least_speed, limits_.most_speed);
}

bool DrivenCamera::has_room() const {
  return plan_ == Plan::ghost || queries_->clearance(pose_.position, radius_ + 0.01) >= radius_;
}

void DrivenCamera::step(const DriveInput& input, double seconds) {
  held_back_ = false;
  turn(input, seconds);
  const Quat rotation = pose_.world_from_camera().rotation;
  const Vec3 linear = bounded(input.linear, limits_.most_speed);
  Vec3 way = rotation.rotate({1, 0, 0}) * (input.forward * speed_ * seconds);
  if (norm(linear) > 0) way += rotation.rotate(linear) * seconds;
  if (norm(way) > 0) move(way);
}

// The three turns are one, about an axis of their own: none comes before another.
void DrivenCamera::turn(const DriveInput& input, double seconds) {
  const Vec3 held{input.roll, input.pitch, input.yaw};
  Vec3 by = (held * (limits_.turn_rate_deg * seconds) + input.look_deg) * kDegree;
  by += bounded(input.angular, limits_.most_turn_rate_deg * kDegree) * seconds;
  const double angle = norm(by);
  if (!(angle > 0)) return;
  const portable::SinCos half = portable::sincos(0.5 * std::min(angle, portable::kPi));
  by = by * (half.sin / angle);
  Pose pose = pose_.world_from_camera();
  pose.rotation = normalized(pose.rotation * Quat(half.cos, by.x, by.y, by.z));
  pose_ = make_driven_pose(pose);
}

void DrivenCamera::move(const Vec3& way) {
  Vec3 left = way;
  const int slides = plan_ == Plan::avoid ? kMostSlides : 0;
  for (int i = 0; i <= slides && norm(left) > 1e-9; ++i) {
    const double share = plan_ == Plan::ghost ? 1 : free_share(pose_.position, left);
    pose_.position += left * share;
    if (share >= 1) break;
    held_back_ = true;
    left *= 1 - share;
    const auto nearest = queries_->find_closest(pose_.position, radius_ + 0.1);
    if (!nearest || nearest->distance < 1e-9) break;
    const Vec3 away = (pose_.position - nearest->point) * (1 / nearest->distance);
    left += away * (std::max(0.0, -dot(left, away)) + kLift);
  }
  const Vec3 corner{limits_.reach, limits_.reach, limits_.reach};
  pose_.position = without_negative_zero(max(-corner, min(corner, pose_.position)));
}

// How much of a straight way the body can go. The clearance falls by no more than what is gone, so
// far from everything the steps are long (Hart 1996, "Sphere tracing"). Who has too little room
// already may go where there is more.
double DrivenCamera::free_share(const Vec3& from, const Vec3& way) const {
  const double length = norm(way);
  double gone = 0, room = queries_->clearance(from, radius_ + length + 1) - radius_;
  while (gone < length) {
    const double next = std::min(length, gone + std::max(room - kKept, kFineStep));
    const double there =
        queries_->clearance(from + way * (next / length), radius_ + length + 1) - radius_;
    if (there < kKept && there <= room) return gone / length;
    gone = next, room = there;
  }
  return 1;
}

}  // namespace rubble
