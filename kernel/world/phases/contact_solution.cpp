#include "kernel/world/phases/contact_solution.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <tuple>

#include "kernel/multibody/free_bodies.h"

namespace rubble {
namespace {

// The bits of a number, such that they compare as the numbers do.
std::uint32_t ordered_bits(float x) {
  std::uint32_t bits = 0;
  x += 0.0F;  // there is one zero
  std::memcpy(&bits, &x, sizeof bits);
  return (bits >> 31) != 0 ? ~bits : bits | 0x80000000u;
}

}  // namespace

bool ContactSolution::OrderKey::operator<(const OrderKey& k) const {
  return std::tie(height, collider_a, collider_b) < std::tie(k.height, k.collider_a, k.collider_b);
}

// Sorts by height, eleven bits at a time, and then those of equal height.
void ContactSolution::sort_keys() {
  constexpr int kBits = 11;  // three rounds for 32 bits
  constexpr std::uint32_t kMask = (1u << kBits) - 1;
  scratch_.resize(keys_.size());
  for (int shift = 0; shift < 32; shift += kBits) {
    std::uint32_t starts[kMask + 2] = {};
    for (const OrderKey& key : keys_) ++starts[((ordered_bits(key.height) >> shift) & kMask) + 1];
    for (std::uint32_t i = 0; i < kMask; ++i) starts[i + 1] += starts[i];
    for (const OrderKey& key : keys_) {
      scratch_[starts[(ordered_bits(key.height) >> shift) & kMask]++] = key;
    }
    keys_.swap(scratch_);
  }
  for (auto begin = keys_.begin(); begin != keys_.end();) {
    auto end = begin + 1;
    while (end != keys_.end() && end->height == begin->height) ++end;
    if (end - begin > 1) std::sort(begin, end);
    begin = end;
  }
}

// The turning of free rotation only; the solver adds gravity in its substeps.
void ContactSolution::turn_freely(const StepPairs& step, StepMotions& motions) {
  motions.velocities.assign(data_.bodies.size(), {});
  motions.displacements.assign(data_.bodies.size(), {});
  pool_.run(int(step.awake.size()), 64, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      const std::int32_t i = step.awake[k];
      const Body& body = data_.bodies[i];
      if (body.free_index < 0) continue;
      const FreeRotation free =
          rotate_freely(body.world_from_com.rotation, body.inertia,
                        blocks_.angular_velocity(body.free_index), settings_.options.step);
      motions.velocities[i] = {body.linear, Vec3f(free.angular)};
    }
  });
}

// Bottom up: what carries is solved before what is carried. The order stays the same from step to
// step unless something moves far: a sweep in another order would disturb what earlier ones
// reached.
void ContactSolution::sort_by_height(StepPairs& step) {
  keys_.resize(step.active.size());
  pool_.run(int(step.active.size()), 128, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      Pair& pair = data_.pairs[step.active[i]];
      const float z = float(data_.bodies[pair.body_a].world_from_com.translation.z) +
                      data_.contacts[step.active[i]].points[0].from_a.z;
      if (std::abs(z - pair.order) > kOrderDistance) pair.order = z;
      keys_[i] = {pair.order, pair.collider_a, pair.collider_b, step.active[i]};
    }
  });
  sort_keys();
  for (std::size_t i = 0; i < step.active.size(); ++i) step.active[i] = keys_[i].index;
}

// Contacts keep the impulses of a heap's substep, since an island may be part of a heap in the next step. So does what a tie may
// bear in one.
void ContactSolution::solve_finer(int kind, const SolverSettings& settings, StepMotions& motions) {
  const std::vector<std::int32_t>& order = islands_.contacts(kind);
  if (order.empty()) return;
  const int substeps = kIslandKinds[kind].substeps;
  const auto scale = [&](float factor) {
    for (const std::int32_t index : order) {
      Contact& contact = data_.contacts[index];
      for (int i = 0; i < contact.count; ++i) contact.points[i].normal_impulse *= factor;
      contact.friction_impulse *= factor;
      contact.twist_impulse *= factor;
      if (std::size_t(index) >= data_.pairs.size()) contact.most *= factor, contact.highest *= factor;
    }
  };
  SolverSettings finer = settings;
  finer.substeps *= substeps;
  scale(1 / float(substeps));
  finer_solvers_[kind].solve(finer, data_.bodies, order, data_.contacts, motions.velocities, motions.displacements, {}, pool_);
  scale(float(substeps));
}

void ContactSolution::run(StepPairs& step, WorldTrees& trees, Ties& ties, const SpeedLimiter& limits,
                          StepMotions& motions) {
  turn_freely(step, motions);
  trees.begin(step);
  std::size_t kept = 0;
  for (const std::int32_t k : live_.find(int(step.active.size()), pool_, [&](int i) { return data_.pairs[step.active[i]].live; }))
    step.active[kept++] = step.active[k];
  step.active.resize(kept);
  sort_by_height(step);
  motions.lateness = limits.calc_lateness();
  // Pieces that are stuck in each other are pushed to and fro for ever, and others with them.
  SolverSettings settings = settings_.solver;
  settings.fading = motions.lateness;
  ties.begin(step, motions.velocities);
  const bool any = islands_.split(data_.bodies, data_.contacts, data_.pairs.size(), step.active, pool_);
  for (int kind = 0; any && kind < kIslandKindCount; ++kind) solve_finer(kind, settings, motions);
  solver_.solve(settings, data_.bodies, any ? islands_.contacts(IslandSubsteps::kHeap) : step.active, data_.contacts,
                motions.velocities, motions.displacements, trees.solved(), pool_);
  ties.end(step);
}

}  // namespace rubble
