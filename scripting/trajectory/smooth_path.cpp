#include "scripting/trajectory/smooth_path.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kernel/base/portable_math.h"

namespace rubble {
namespace {

constexpr long kReach = 2;  // control points before an interval that shape it
constexpr double kWildestTurn = 90;  // within a knot; unit: degree

using SplineWeights = std::array<double, 6>;

// Of the control points of an interval, u: from 0 to 1 within it. Uniform quintic B-spline.
SplineWeights weights_at(double u) {
  const double r = 1 - u, u2 = u * u, u3 = u2 * u, u4 = u3 * u, u5 = u4 * u;
  return {r * r * r * r * r / 120,
          (26 - 50 * u + 20 * u2 + 20 * u3 - 20 * u4 + 5 * u5) / 120,
          (66 - 60 * u2 + 30 * u4 - 10 * u5) / 120,
          (26 + 50 * u + 20 * u2 - 20 * u3 - 20 * u4 + 10 * u5) / 120,
          (1 + 5 * u + 10 * u2 + 10 * u3 + 5 * u4 - 5 * u5) / 120,
          u5 / 120};
}

// Derived by u.
SplineWeights rates_at(double u) {
  const double r = 1 - u, u2 = u * u, u3 = u2 * u, u4 = u3 * u;
  return {-r * r * r * r / 24,
          (-10 + 8 * u + 12 * u2 - 16 * u3 + 5 * u4) / 24,
          (-24 * u + 24 * u3 - 10 * u4) / 24,
          (10 + 8 * u - 12 * u2 - 16 * u3 + 10 * u4) / 24,
          (1 + 4 * u + 6 * u2 + 4 * u3 - 5 * u4) / 24,
          u4 / 24};
}

// Derived by u twice.
SplineWeights changes_at(double u) {
  const double r = 1 - u, u2 = u * u, u3 = u2 * u;
  return {r * r * r / 6,
          (2 + 6 * u - 12 * u2 + 5 * u3) / 6,
          (-6 + 18 * u2 - 10 * u3) / 6,
          (2 - 6 * u - 12 * u2 + 10 * u3) / 6,
          (1 + 3 * u + 3 * u2 - 5 * u3) / 6,
          u3 / 6};
}

// Derived by u three times.
SplineWeights jerks_at(double u) {
  const double r = 1 - u, u2 = u * u;
  return {-r * r / 2,           (2 - 8 * u + 5 * u2) / 2,  6 * u - 5 * u2,
          -1 - 4 * u + 5 * u2, (1 + 2 * u - 5 * u2) / 2, u2 / 2};
}

Vec3 sum(const SplineWeights& weights, const Vec3* points) {
  Vec3 out;
  for (std::size_t i = 0; i < weights.size(); ++i) out += points[i] * weights[i];
  return out;
}

Quat sum(const SplineWeights& weights, const Quat* points) {
  Quat out{0, 0, 0, 0};
  for (std::size_t i = 0; i < weights.size(); ++i) {
    out.w += points[i].w * weights[i];
    out.x += points[i].x * weights[i];
    out.y += points[i].y * weights[i];
    out.z += points[i].z * weights[i];
  }
  return out;
}

double dot(const Quat& a, const Quat& b) { return a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z; }

// `p` on the other side of `centre`, as far away.
Pose reflected(const Pose& p, const Pose& centre) {
  return {normalized(centre.rotation * p.rotation.conjugate() * centre.rotation),
          centre.translation * 2.0 - p.translation};
}

// The path with what comes before and after it. Reflecting it in its ends keeps the speed there, and
// the average goes through the ends themselves.
Pose extended(const std::function<Pose(double)>& path, long knot, long last, double step,
              PathEnds ends) {
  const auto own = [&](long k) { return path(step * double(std::min(std::max(k, 0L), last))); };
  if (ends == PathEnds::at_rest || (knot >= 0 && knot <= last)) return own(knot);
  const long end = knot < 0 ? 0 : last;
  return reflected(extended(path, 2 * end - knot, last, step, ends), own(end));
}

}  // namespace

SmoothPath::SmoothPath(const std::function<Pose(double)>& path, double duration, double knot,
                       PathEnds ends) {
  const long last = std::max(1L, long(std::ceil(duration / knot - 1e-9)));
  const long margin = ends == PathEnds::at_rest ? kReach : 0;
  knot_ = duration / double(last);
  delay_ = knot_ * double(margin);
  intervals_ = std::size_t(last + 2 * margin);
  for (long k = -margin - kReach; k <= last + margin + kReach; ++k) {
    const Pose pose = extended(path, k, last, knot_, ends);
    positions_.push_back(pose.translation);
    rotations_.push_back(pose.rotation);
  }
  align_signs();
}

void SmoothPath::align_signs() {
  for (std::size_t i = 1; i < rotations_.size(); ++i) {
    Quat& q = rotations_[i];
    if (dot(rotations_[i - 1], q) < 0) q = {-q.w, -q.x, -q.y, -q.z};
  }
}

double SmoothPath::duration() const { return knot_ * double(intervals_); }

CameraMotion SmoothPath::motion_at(double t) const {
  const double s = std::min(std::max(t / knot_, 0.0), double(intervals_));
  const std::size_t i = std::min(std::size_t(s), intervals_ - 1);
  const double u = s - double(i);
  const SplineWeights weights = weights_at(u), rates = rates_at(u);
  const Vec3* points = positions_.data() + i;
  const Quat q = sum(weights, rotations_.data() + i), rate = sum(rates, rotations_.data() + i);
  const Quat turn = q.conjugate() * rate;
  CameraMotion motion;
  motion.world_from_camera = {normalized(q), sum(weights, points)};
  motion.velocity = sum(rates, points) * (1 / knot_);
  motion.acceleration = sum(changes_at(u), points) * (1 / (knot_ * knot_));
  motion.angular_velocity = Vec3{turn.x, turn.y, turn.z} * (2 / (dot(q, q) * knot_));
  return motion;
}

Pose SmoothPath::at(double t) const { return motion_at(t).world_from_camera; }

double SmoothPath::largest_jerk() const {
  constexpr int kPlaces = 8;
  double largest = 0;
  for (std::size_t i = 0; i < intervals_; ++i)
    for (int k = 0; k <= kPlaces; ++k)
      largest = std::max(largest, norm(sum(jerks_at(double(k) / kPlaces), positions_.data() + i)));
  return largest / (knot_ * knot_ * knot_);
}

std::optional<SmoothPath::Turn> SmoothPath::wildest_turn() const {
  Turn wildest;
  for (std::size_t i = 1; i < rotations_.size(); ++i) {
    const double cosine = std::min(1.0, dot(rotations_[i - 1], rotations_[i]));
    const double angle = 2 * portable::atan2(std::sqrt(1 - cosine * cosine), cosine);
    if (angle * 180 / portable::kPi <= wildest.angle_deg) continue;
    const double time = knot_ * (double(i) - 0.5 - double(kReach)) - delay_;
    wildest = {std::max(0.0, time), angle * 180 / portable::kPi};
  }
  if (wildest.angle_deg <= kWildestTurn) return std::nullopt;
  return wildest;
}

}  // namespace rubble
