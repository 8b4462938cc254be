#include "kernel/simbody_blocks.h"

#include <Simbody.h>

#include <utility>

namespace rubble {
namespace {

SimTK::MassProperties mass_properties(const FreeBody& body) {
  const auto& r = body.inertia.rows;
  return {body.mass, SimTK::Vec3(0),
          SimTK::Inertia(SimTK::Vec3(r[0].x, r[1].y, r[2].z), SimTK::Vec3(r[0].y, r[0].z, r[1].z))};
}

}  // namespace

// q of a Free mobilizer: quaternion w x y z, then the position; u: angular, then linear velocity,
// both in the ground frame. A body's frame sits in its centre of mass.
struct SimbodyBlocks::Block {
  Block() : matter(system) {}

  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter;
  std::vector<SimTK::MobilizedBody::Free> bodies;
  SimTK::State state;
  SimTK::Vector rate, qdot;
  int first = 0;  // number of its first body
};

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
    auto block = std::make_unique<Block>();
    block->first = size_;
    for (std::size_t i = begin; i < end; ++i) {
      block->bodies.emplace_back(block->matter.Ground(), SimTK::Transform(),
                                 SimTK::Body::Rigid(mass_properties(bodies[i])),
                                 SimTK::Transform());
      block_index_.push_back(std::int32_t(blocks_.size()));
      slot_.push_back(std::int32_t(i - begin));
    }
    block->state = block->system.realizeTopology();
    block->system.realizeModel(block->state);
    block->rate.resize(block->state.getNU());
    block->qdot.resize(block->state.getNQ());
    blocks_.push_back(std::move(block));
    for (std::size_t i = begin; i < end; ++i, ++size_) {
      set_pose(size_, bodies[i].world_from_com);
      set_velocity(size_, bodies[i].linear_velocity, bodies[i].angular_velocity);
    }
  }
  return first;
}

void SimbodyBlocks::set_velocity(int body, const Vec3& linear, const Vec3& angular) {
  SimTK::Vector& u = block_of(body).state.updU();
  const int at = 6 * slot_[body];
  u[at] = angular.x, u[at + 1] = angular.y, u[at + 2] = angular.z;
  u[at + 3] = linear.x, u[at + 4] = linear.y, u[at + 5] = linear.z;
}

Vec3 SimbodyBlocks::angular_velocity(int body) const {
  const SimTK::Vector& u = block_of(body).state.getU();
  const int at = 6 * slot_[body];
  return {u[at], u[at + 1], u[at + 2]};
}

Vec3 SimbodyBlocks::linear_velocity(int body) const {
  const SimTK::Vector& u = block_of(body).state.getU();
  const int at = 6 * slot_[body] + 3;
  return {u[at], u[at + 1], u[at + 2]};
}

void SimbodyBlocks::advance(int index, const std::vector<std::uint8_t>& moves,
                            const Vec3* extra_linear, const Vec3* extra_angular, double dt) {
  Block& block = *blocks_[index];
  const SimTK::Vector& u = block.state.getU();
  const int count = int(block.bodies.size());
  for (int slot = 0; slot < count; ++slot) {
    const int body = block.first + slot, at = 6 * slot;
    const Vec3& l = extra_linear[body];
    const Vec3& a = extra_angular[body];
    block.rate[at] = u[at] + a.x, block.rate[at + 1] = u[at + 1] + a.y;
    block.rate[at + 2] = u[at + 2] + a.z, block.rate[at + 3] = u[at + 3] + l.x;
    block.rate[at + 4] = u[at + 4] + l.y, block.rate[at + 5] = u[at + 5] + l.z;
  }
  block.system.realize(block.state, SimTK::Stage::Position);
  block.matter.multiplyByN(block.state, false, block.rate, block.qdot);
  SimTK::Vector& q = block.state.updQ();
  for (int slot = 0; slot < count; ++slot) {
    if (!moves[block.first + slot]) continue;
    const int at = 7 * slot;
    const Quat turned = normalized(Quat{q[at] + block.qdot[at] * dt,
                                        q[at + 1] + block.qdot[at + 1] * dt,
                                        q[at + 2] + block.qdot[at + 2] * dt,
                                        q[at + 3] + block.qdot[at + 3] * dt});
    q[at] = turned.w, q[at + 1] = turned.x, q[at + 2] = turned.y, q[at + 3] = turned.z;
    for (int i = 4; i < 7; ++i) q[at + i] += block.qdot[at + i] * dt;
  }
  block.system.realize(block.state, SimTK::Stage::Position);
}

Pose SimbodyBlocks::world_from_com(int body) const {
  const SimTK::Vector& q = block_of(body).state.getQ();
  const int at = 7 * slot_[body];
  return {{q[at], q[at + 1], q[at + 2], q[at + 3]}, {q[at + 4], q[at + 5], q[at + 6]}};
}

void SimbodyBlocks::set_pose(int body, const Pose& pose) {
  SimTK::Vector& q = block_of(body).state.updQ();
  const int at = 7 * slot_[body];
  q[at] = pose.rotation.w, q[at + 1] = pose.rotation.x;
  q[at + 2] = pose.rotation.y, q[at + 3] = pose.rotation.z;
  q[at + 4] = pose.translation.x, q[at + 5] = pose.translation.y;
  q[at + 6] = pose.translation.z;
}

}  // namespace rubble
