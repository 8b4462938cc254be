#include "scripting/trajectory/simulated_path.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace rubble {
namespace {

Quat scaled(const Quat& q, double s) { return {q.w * s, q.x * s, q.y * s, q.z * s}; }
Quat sum(const Quat& a, const Quat& b) { return {a.w + b.w, a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec3 scaled(const Vec3& v, double s) { return v * s; }
Vec3 sum(const Vec3& a, const Vec3& b) { return a + b; }
double inner(const Quat& a, const Quat& b) { return a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z; }

// Half the way from the neighbour before to the one after; at the ends to the only one.
template <typename T>
T central_difference(const T& before, const T& after, std::size_t steps) {
  return scaled(sum(after, scaled(before, -1)), 1 / double(steps));
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

SimulatedPath::SimulatedPath(const std::vector<Pose>& poses, double step) : step_(step) {
  if (poses.size() < 2) throw std::logic_error("a simulated path of fewer than two poses");
  for (const Pose& pose : poses) add(pose);
}

void SimulatedPath::add(Pose pose) {
  if (!poses_.empty() && inner(poses_.back().rotation, pose.rotation) < 0) pose.rotation = scaled(pose.rotation, -1);
  poses_.push_back(pose);
  velocities_.emplace_back(), turnings_.emplace_back();
  const std::size_t last = poses_.size() - 1;
  if (last == 0) return;
  set_tangents(last - 1);
  set_tangents(last);
}

void SimulatedPath::set_tangents(std::size_t i) {
  if (i == 0 && first_ == 0 && from_rest_) return;
  const std::size_t before = i > 0 ? i - 1 : 0, after = std::min(poses_.size() - 1, i + 1);
  const Pose &a = poses_[before], &b = poses_[after];
  velocities_[i] = central_difference(a.translation, b.translation, after - before);
  turnings_[i] = central_difference(a.rotation, b.rotation, after - before);
}

void SimulatedPath::clear() {
  poses_.clear(), velocities_.clear(), turnings_.clear();
  first_ = 0;
}

void SimulatedPath::forget_before(std::int64_t step) {
  const std::int64_t gone = std::min(step, last_step() - 2) - first_;
  if (gone <= 0) return;
  poses_.erase(poses_.begin(), poses_.begin() + gone);
  velocities_.erase(velocities_.begin(), velocities_.begin() + gone);
  turnings_.erase(turnings_.begin(), turnings_.begin() + gone);
  first_ += gone;
}

SimulatedPath::Place SimulatedPath::find(double t) const {
  const double steps = std::clamp(t / step_ - double(first_), 0.0, double(poses_.size() - 1));
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
