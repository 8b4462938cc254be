#include "kernel/multibody/free_bodies.h"

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

}  // namespace rubble
