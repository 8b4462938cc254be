#include "kernel/multibody/simbody_blocks.h"

#ifndef RUBBLE_WITHOUT_SIMBODY
#include <Simbody.h>
#endif

#include <algorithm>
#include <utility>

namespace rubble {
namespace {

#ifndef RUBBLE_WITHOUT_SIMBODY
SimTK::MassProperties mass_properties(const FreeBody& body) {
  const auto& r = body.inertia.rows;
  return {body.mass, SimTK::Vec3(0),
          SimTK::Inertia(SimTK::Vec3(r[0].x, r[1].y, r[2].z), SimTK::Vec3(r[0].y, r[0].z, r[1].z))};
}
#endif

Quat turn(const Quat& r, const Vec3& w, double dt) {
  const Quat spin = Quat{0, w.x, w.y, w.z} * r;
  const double half = 0.5 * dt;
  return normalized(Quat{r.w + spin.w * half, r.x + spin.x * half, r.y + spin.y * half,
                         r.z + spin.z * half});
}

}  // namespace

// q of a Free mobilizer: quaternion w x y z, then the position; u: angular, then linear velocity,
// both in the ground frame. A body's frame sits in its centre of mass.
#ifndef RUBBLE_WITHOUT_SIMBODY
struct SimbodyBlocks::Block {
  Block(const FreeBody* bodies, int number) : matter(system), count(number) {
    for (int i = 0; i < number; ++i)
      SimTK::MobilizedBody::Free(matter.Ground(), SimTK::Transform(),
                                 SimTK::Body::Rigid(mass_properties(bodies[i])), SimTK::Transform());
    system.realizeTopology();
    // The system's own state: a copy of it would take as much again, three kilobytes a body.
    SimTK::State& state = system.updDefaultState();
    system.realizeModel(state);
    q = state.updQ().updContiguousScalarData();
    u = state.updU().updContiguousScalarData();
  }

  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter;
  // Where the State has them. Nothing of it is realised beyond its model, so nothing goes stale by what is written here:
  // updQ() and updU() for each step of a block would only look for that.
  double *q = nullptr, *u = nullptr;
  int first = 0;                            // number of its first body
  int count = 0;
};
#else
// The same numbers, kept here: nothing of free bodies is computed by Simbody.
struct SimbodyBlocks::Block {
  Block(const FreeBody*, int number) : q(7 * std::size_t(number)), u(6 * std::size_t(number)), count(number) {}

  std::vector<double> q, u;
  int first = 0;
  int count = 0;
};
#endif

SimbodyBlocks::SimbodyBlocks() = default;
SimbodyBlocks::~SimbodyBlocks() = default;
SimbodyBlocks::SimbodyBlocks(SimbodyBlocks&&) noexcept = default;
SimbodyBlocks& SimbodyBlocks::operator=(SimbodyBlocks&&) noexcept = default;

int SimbodyBlocks::block_count() const { return int(blocks_.size()); }
int SimbodyBlocks::first_of(int block) const {
  return block < block_count() ? blocks_[block]->first : size_;
}
SimbodyBlocks::Block& SimbodyBlocks::block_of(int body) const {
  return *blocks_[block_index_[body]];
}

int SimbodyBlocks::add(const std::vector<FreeBody>& bodies) {
  const int first = size_;
  for (std::size_t begin = 0; begin < bodies.size(); begin += kBlockSize) {
    const std::size_t end = std::min(bodies.size(), begin + kBlockSize);
    auto block = std::make_unique<Block>(&bodies[begin], int(end - begin));
    block->first = size_;
    for (std::size_t i = begin; i < end; ++i) {
      block_index_.push_back(std::int32_t(blocks_.size()));
      slot_.push_back(std::int32_t(i - begin));
    }
    blocks_.push_back(std::move(block));
    for (std::size_t i = begin; i < end; ++i, ++size_) {
      set_pose(size_, bodies[i].world_from_com);
      set_velocity(size_, bodies[i].linear_velocity, bodies[i].angular_velocity);
    }
  }
  return first;
}

void SimbodyBlocks::set_velocity(int body, const Vec3& linear, const Vec3& angular) {
  double* u = &block_of(body).u[0];
  const int at = 6 * slot_[body];
  u[at] = angular.x, u[at + 1] = angular.y, u[at + 2] = angular.z;
  u[at + 3] = linear.x, u[at + 4] = linear.y, u[at + 5] = linear.z;
}

Vec3 SimbodyBlocks::angular_velocity(int body) const {
  const double* u = &block_of(body).u[0];
  const int at = 6 * slot_[body];
  return {u[at], u[at + 1], u[at + 2]};
}

Vec3 SimbodyBlocks::linear_velocity(int body) const {
  const double* u = &block_of(body).u[0];
  const int at = 6 * slot_[body] + 3;
  return {u[at], u[at + 1], u[at + 2]};
}

// The kinematics of a Free mobilizer, dq/dt = N(q) u, written out: Simbody's multiplyByN() computes
// the same, but its arm64 build gave other last bits (most likely by fused multiply-adds).
void SimbodyBlocks::advance(int index, const std::vector<std::uint8_t>& moves,
                            const BodyRates* rates, double dt) {
  Block& block = *blocks_[index];
  double* u = &block.u[0];
  double* q = &block.q[0];
  const int count = block.count;
  for (int slot = 0; slot < count; ++slot) {
    const int body = block.first + slot;
    if (!moves[body]) continue;
    const int iu = 6 * slot, iq = 7 * slot;
    const BodyRates& rate = rates[body];
    for (int i = 0; i < 3; ++i) {
      u[iu + i] = rate.angular[i];
      u[iu + 3 + i] = rate.linear[i];
    }
    const Vec3 v = rate.linear + rate.extra_linear;
    const Quat turned = rate.turns_freely
                            ? rate.rotation
                            : turn({q[iq], q[iq + 1], q[iq + 2], q[iq + 3]},
                                   rate.angular + rate.extra_angular, dt);
    q[iq] = turned.w, q[iq + 1] = turned.x, q[iq + 2] = turned.y, q[iq + 3] = turned.z;
    for (int i = 0; i < 3; ++i) q[iq + 4 + i] += v[i] * dt;
  }
}

Pose SimbodyBlocks::world_from_com(int body) const {
  const double* q = &block_of(body).q[0];
  const int at = 7 * slot_[body];
  return {{q[at], q[at + 1], q[at + 2], q[at + 3]}, {q[at + 4], q[at + 5], q[at + 6]}};
}

void SimbodyBlocks::set_pose(int body, const Pose& pose) {
  double* q = &block_of(body).q[0];
  const int at = 7 * slot_[body];
  q[at] = pose.rotation.w, q[at + 1] = pose.rotation.x;
  q[at + 2] = pose.rotation.y, q[at + 3] = pose.rotation.z;
  q[at + 4] = pose.translation.x, q[at + 5] = pose.translation.y;
  q[at + 6] = pose.translation.z;
}

}  // namespace rubble
