#include "scripting/trajectory/simulated_path.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace rubble {
namespace {

Quat scaled(const Quat& q, double s) { return {q.w * s, q.x * s, q.y * s, q.z * s}; }
Quat sum(const Quat& a, const Quat& b) { return {a.w + b.w, a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec3 scaled(const Vec3& v, double s) { return v * s; }
Vec3 sum(const Vec3& a, const Vec3& b) { return a + b; }
double inner(const Quat& a, const Quat& b) { return a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z; }

// Half the way from the neighbour before to the one after; at the ends to the only one.
template <typename T>
std::vector<T> central_differences(const std::vector<T>& values) {
  std::vector<T> differences;
  const std::size_t last = values.size() - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    const std::size_t before = i > 0 ? i - 1 : 0, after = std::min(last, i + 1);
    differences.push_back(
        scaled(sum(values[after], scaled(values[before], -1)), 1 / double(after - before)));
  }
  return differences;
}

// HermiteWeights of the two values and the two tangents of a cubic Hermite curve.
struct HermiteWeights {
  double from, to, leave, arrive;
};
HermiteWeights value_weights(double s) {
  const double s2 = s * s, s3 = s2 * s;
  return {2 * s3 - 3 * s2 + 1, -2 * s3 + 3 * s2, s3 - 2 * s2 + s, s3 - s2};
}
HermiteWeights rate_weights(double s) {
  return {6 * s * s - 6 * s, -6 * s * s + 6 * s, 3 * s * s - 4 * s + 1, 3 * s * s - 2 * s};
}
HermiteWeights second_weights(double s) { return {12 * s - 6, -12 * s + 6, 6 * s - 4, 6 * s - 2}; }

template <typename T>
T blend(const HermiteWeights& w, const T& from, const T& to, const T& leave, const T& arrive) {
  return sum(sum(scaled(from, w.from), scaled(to, w.to)),
             sum(scaled(leave, w.leave), scaled(arrive, w.arrive)));
}

}  // namespace

SimulatedPath::SimulatedPath(std::vector<Pose> poses, double step, std::int64_t first)
    : poses_(std::move(poses)), step_(step), first_(double(first)) {
  if (poses_.size() < 2) throw std::logic_error("a simulated path of fewer than two poses");
  std::vector<Vec3> positions;
  std::vector<Quat> rotations;
  for (Pose& pose : poses_) {
    if (!rotations.empty() && inner(rotations.back(), pose.rotation) < 0)
      pose.rotation = scaled(pose.rotation, -1);
    positions.push_back(pose.translation);
    rotations.push_back(pose.rotation);
  }
  velocities_ = central_differences(positions);
  turnings_ = central_differences(rotations);
}

double SimulatedPath::duration() const { return step_ * (first_ + double(poses_.size() - 1)); }

SimulatedPath::Place SimulatedPath::find(double t) const {
  const double steps = std::clamp(t / step_ - first_, 0.0, double(poses_.size() - 1));
  Place place;
  place.step = std::min(std::size_t(steps), poses_.size() - 2);
  place.share = steps - double(place.step);
  return place;
}

Pose SimulatedPath::at(double t) const {
  const Place place = find(t);
  const std::size_t i = place.step;
  if (place.share == 0) return poses_[i];
  if (place.share == 1) return poses_[i + 1];
  const HermiteWeights w = value_weights(place.share);
  return {normalized(blend(w, poses_[i].rotation, poses_[i + 1].rotation, turnings_[i],
                           turnings_[i + 1])),
          blend(w, poses_[i].translation, poses_[i + 1].translation, velocities_[i],
                velocities_[i + 1])};
}

// Of a quaternion q that is not normalized, w = 2 Im(q* dq/dt) / |q|^2 in the body's frame.
CameraMotion SimulatedPath::motion_at(double t) const {
  const Place place = find(t);
  const std::size_t i = place.step;
  const auto position = [&](const HermiteWeights& w) {
    return blend(w, poses_[i].translation, poses_[i + 1].translation, velocities_[i],
                 velocities_[i + 1]);
  };
  const auto rotation = [&](const HermiteWeights& w) {
    return blend(w, poses_[i].rotation, poses_[i + 1].rotation, turnings_[i], turnings_[i + 1]);
  };
  CameraMotion motion;
  motion.world_from_camera = at(t);
  motion.velocity = position(rate_weights(place.share)) * (1 / step_);
  motion.acceleration = position(second_weights(place.share)) * (1 / (step_ * step_));
  const Quat q = rotation(value_weights(place.share));
  const Quat turning = q.conjugate() * rotation(rate_weights(place.share));
  motion.angular_velocity =
      Vec3{turning.x, turning.y, turning.z} * (2 / (step_ * inner(q, q)));
  return motion;
}

}  // namespace rubble
