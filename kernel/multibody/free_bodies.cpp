#include "kernel/multibody/free_bodies.h"

#include <algorithm>
#include <cmath>

namespace rubble {
namespace {

Quat turn(const Quat& r, const Vec3& w, double dt) {
  const Quat spin = Quat{0, w.x, w.y, w.z} * r;
  const double half = 0.5 * dt;
  return normalized(Quat{r.w + spin.w * half, r.x + spin.x * half, r.y + spin.y * half,
                         r.z + spin.z * half});
}

}  // namespace

int FreeBodies::add(const std::vector<FreeBody>& bodies) {
  const int first = size();
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (i % kBlockSize == 0) first_.push_back(size());
    block_.push_back(std::int32_t(first_.size()) - 1);
    coordinates_.push_back(bodies[i].world_from_com);
    speeds_.push_back({bodies[i].linear_velocity, bodies[i].angular_velocity});
  }
  return first;
}

void FreeBodies::set_velocity(int body, const Vec3& linear, const Vec3& angular) {
  speeds_[std::size_t(body)] = {linear, angular};
}

void FreeBodies::set_pose(int body, const Pose& pose) { coordinates_[std::size_t(body)] = pose; }

void FreeBodies::advance(int body, const BodyRates& rate, double dt) {
  speeds_[std::size_t(body)] = {rate.linear, rate.angular};
  Pose& pose = coordinates_[std::size_t(body)];
  const Vec3 v = rate.linear + rate.extra_linear;
  pose.rotation = rate.turns_freely ? rate.rotation
                                    : turn(pose.rotation, rate.angular + rate.extra_angular, dt);
  for (int i = 0; i < 3; ++i) pose.translation[i] += v[i] * dt;
}

namespace {

constexpr double kSubstepAngle = 0.125;  // turned in a substep at most: energy stays within 1 % in 20 s; unit: rad
constexpr double kMostSubsteps = 512;    // 3,840 rad/s at 1/60 s
constexpr int kMostIterations = 8;       // of Newton's method; three are usual
// Newton's iteration has converged when the square of its change is this share of the speed's square.
constexpr double kConverged = 1e-30;
// Below this the gyroscopic torque changes the velocity by less than rounding; unit: rad/s.
constexpr double kStill = 1e-8;

Mat3 skew(const Vec3& v) { return {{{0, -v.z, v.y}, {v.z, 0, -v.x}, {-v.y, v.x, 0}}}; }

Vec3 solve(const Mat3& m, const Vec3& b) {
  const Vec3 c0 = cross(m.rows[1], m.rows[2]), c1 = cross(m.rows[2], m.rows[0]),
             c2 = cross(m.rows[0], m.rows[1]);
  return (c0 * b.x + c1 * b.y + c2 * b.z) * (1 / dot(m.rows[0], c0));
}

// I (w1 - w0) + h w x I w = 0 at w = (w0 + w1) / 2, all in the body.
Vec3 step_velocity(const Mat3& inertia, const Vec3& w0, double h) {
  Vec3 w1 = w0;
  for (int i = 0; i < kMostIterations; ++i) {
    const Vec3 w = (w0 + w1) * 0.5, iw = inertia * w;
    const Vec3 error = inertia * (w1 - w0) + cross(w, iw) * h;
    const Vec3 change = solve(inertia + (skew(w) * inertia + skew(iw) * -1.0) * (0.5 * h), error);
    w1 += change * -1.0;
    if (dot(change, change) <= kConverged * dot(w1, w1)) break;
  }
  return w1;
}

// Turned by the rotation vector `angle` (in the body), which must be small: tan(x) by its series.
Quat turned(const Quat& q, const Vec3& angle) {
  const double x2 = 0.25 * dot(angle, angle);  // of the half angle
  const double half = 0.5 * (1 + x2 * (1.0 / 3 + x2 * (2.0 / 15)));
  return normalized(q * Quat{1, angle.x * half, angle.y * half, angle.z * half});
}

// The smallest turn that brings one vector onto another of the same length, not opposite to it.
Quat turn_onto(const Vec3& from, const Vec3& to) {
  const Vec3 axis = cross(from, to);
  return normalized(Quat{norm(from) * norm(to) + dot(from, to), axis.x, axis.y, axis.z});
}

}  // namespace

FreeRotation rotate_freely(const Quat& world_from_body, const Mat3& inertia, const Vec3& angular,
                           double dt) {
  const double speed = norm(angular);
  Vec3 w0 = world_from_body.conjugate().rotate(angular);
  if (!(speed > kStill)) return {turned(world_from_body, w0 * dt), angular};
  const double count = std::min(kMostSubsteps, std::floor(speed * dt / kSubstepAngle) + 1);
  const double h = dt / count;
  const Vec3 momentum = world_from_body.rotate(inertia * w0);
  Quat q = world_from_body;
  for (int i = 0; i < int(count); ++i) {
    const Vec3 w1 = step_velocity(inertia, w0, h);
    q = turned(q, (w0 + w1) * (0.5 * h));
    w0 = w1;
  }
  // The momentum keeps its length, and is turned back to where it points in the world.
  q = normalized(turn_onto(q.rotate(inertia * w0), momentum) * q);
  return {q, q.rotate(w0)};
}

}  // namespace rubble
