// The stages of one step, in the order of World::step(). Pairs are found in world_pairs.cpp; who
// sleeps is decided in world_sleep.cpp.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>

#include "kernel/multibody/free_rotation.h"
#include "kernel/solver/speed_limits.h"
#include "kernel/world/world_impl.h"

namespace rubble {
namespace {

constexpr int kMostSplits = 4;  // times in a step that contacts are solved anew as something broke; unit: 1

class Stopwatch {
 public:
  explicit Stopwatch(double& total) : total_(total), start_(std::chrono::steady_clock::now()) {}
  ~Stopwatch() {
    total_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  double& total_;
  std::chrono::steady_clock::time_point start_;
};

// The bits of a number, such that they compare as the numbers do.
std::uint32_t ordered_bits(float x) {
  std::uint32_t bits = 0;
  x += 0.0F;  // there is one zero
  std::memcpy(&bits, &x, sizeof bits);
  return (bits >> 31) != 0 ? ~bits : bits | 0x80000000u;
}

// Sorts by height, eleven bits at a time, and then those of equal height.
void sort_keys(std::vector<OrderKey>& keys, std::vector<OrderKey>& scratch) {
  constexpr int kBits = 11;  // three rounds for 32 bits
  constexpr std::uint32_t kMask = (1u << kBits) - 1;
  scratch.resize(keys.size());
  for (int shift = 0; shift < 32; shift += kBits) {
    std::uint32_t starts[kMask + 2] = {};
    for (const OrderKey& key : keys) ++starts[((ordered_bits(key.height) >> shift) & kMask) + 1];
    for (std::uint32_t i = 0; i < kMask; ++i) starts[i + 1] += starts[i];
    for (const OrderKey& key : keys) {
      scratch[starts[(ordered_bits(key.height) >> shift) & kMask]++] = key;
    }
    keys.swap(scratch);
  }
  for (auto begin = keys.begin(); begin != keys.end();) {
    auto end = begin + 1;
    while (end != keys.end() && end->height == begin->height) ++end;
    if (end - begin > 1) std::sort(begin, end);
    begin = end;
  }
}

}  // namespace

// The turning of free rotation only; the solver adds gravity in its substeps.
void World::Impl::apply_forces() {
  velocities.assign(data.bodies.size(), {});
  displacements.assign(data.bodies.size(), {});
  pool.run(int(awake_bodies.size()), 64, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      const std::int32_t i = awake_bodies[k];
      const Body& body = data.bodies[i];
      if (body.simbody_index < 0) continue;
      const FreeRotation free = rotate_freely(body.world_from_com.rotation, body.inertia,
                                              blocks.angular_velocity(body.simbody_index), options.step);
      velocities[i] = {body.linear, Vec3f(free.angular)};
    }
  });
}

// Bottom up: what carries is solved before what is carried. The order stays the same from step to
// step unless something moves far: a sweep in another order would disturb what earlier ones
// reached.
void World::Impl::sort_by_height() {
  order_keys.resize(active.size());
  pool.run(int(active.size()), 128, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      Pair& pair = data.pairs[active[i]];
      const float z = float(data.bodies[pair.body_a].world_from_com.translation.z) +
                      data.contacts[active[i]].points[0].from_a.z;
      if (std::abs(z - pair.order) > kOrderDistance) pair.order = z;
      order_keys[i] = {pair.order, pair.collider_a, pair.collider_b, active[i]};
    }
  });
  sort_keys(order_keys, key_scratch);
  for (std::size_t i = 0; i < active.size(); ++i) active[i] = order_keys[i].index;
}

void World::Impl::solve_contacts() {
  active.erase(std::remove_if(active.begin(), active.end(),
                              [&](std::int32_t i) { return !data.pairs[i].live; }),
               active.end());
  sort_by_height();
  lateness = calc_lateness();
  // Pieces that are stuck in each other are pushed to and fro for ever, and others with them.
  SolverSettings settings = solver_settings;
  settings.fading = lateness;
  begin_ties();
  solver.solve(settings, data.bodies, active, data.contacts, velocities, displacements,
               solved_trees, pool);
  end_ties();
}

// The speeds after the step, and the extra rates that make up its displacement.
void World::Impl::set_rates(std::size_t index) {
  const Body& body = data.bodies[index];
  BodyRates& r = rates[body.simbody_index];
  r = {};
  if (body.touching || solver.has_intervened(std::int32_t(index))) {
    Motion m = velocities[index];
    const float spin = norm(m.angular);
    const float most = calc_most_spin(body);
    if (spin > most && !does_roll(index)) m.angular *= most / spin;
    if (lateness > 0 && spin < kSwingingSpin) m.angular *= keep_of_late_spin(body, m.angular, spin);
    r.linear = Vec3(m.linear), r.angular = Vec3(m.angular);
    const double per_step = 1 / options.step;
    r.extra_linear = Vec3(displacements[index].linear) * per_step - r.linear;
    r.extra_angular = Vec3(displacements[index].angular) * per_step - r.angular;
  } else {
    // Nothing touches it: the exact parabola and free rotation, in double precision.
    const FreeRotation free = rotate_freely(body.world_from_com.rotation, body.inertia,
                                            blocks.angular_velocity(body.simbody_index), options.step);
    r.linear = blocks.linear_velocity(body.simbody_index);
    r.linear.z -= options.gravity * options.step;
    r.extra_linear = {0, 0, 0.5 * options.gravity * options.step};
    r.angular = free.angular;
    r.turns_freely = true;
    r.rotation = free.rotation;
  }
}

// How far any point of a body can have gone in the step.
double World::Impl::calc_travel(const Body& body) const {
  const BodyRates& r = rates[body.simbody_index];
  return options.step * (norm(r.linear + r.extra_linear) +
                         norm(r.angular + r.extra_angular) * double(body.radius));
}

void World::Impl::advance() {
  moves.assign(blocks.size(), 0);
  rates.resize(blocks.size());
  block_awake.assign(blocks.block_count(), 0);
  body_of.resize(blocks.size());
  for (std::int32_t i : awake_bodies) {
    const Body& body = data.bodies[i];
    if (body.simbody_index < 0) continue;
    moves[body.simbody_index] = 1;
    body_of[body.simbody_index] = i;
    block_awake[blocks.block_of_body(body.simbody_index)] = 1;
  }
  pool.run(blocks.block_count(), 4, [&](int begin, int end) {
    for (int block = begin; block < end; ++block) {
      if (!block_awake[block]) continue;
      for (int mobile = blocks.first_of(block); mobile < blocks.first_of(block + 1); ++mobile) {
        if (moves[mobile]) set_rates(body_of[mobile]);
      }
      blocks.advance(block, moves, rates.data(), options.step);
      for (int mobile = blocks.first_of(block); mobile < blocks.first_of(block + 1); ++mobile) {
        if (!moves[mobile]) continue;
        Body& body = data.bodies[body_of[mobile]];
        body.travel += calc_travel(body);
        mirror(body);
        refresh(body);
      }
    }
  });
}

// A contact counts as touching when it carries an impulse.
void World::Impl::update_touching() {
  for (std::int32_t i : awake_bodies) data.bodies[i].touching = false;
  each_solved([this](const Contact& contact) {
    if (contact.pressed <= 0) return;
    for (std::int32_t i : {contact.body_a, contact.body_b}) {
      if (i == kGround) continue;
      data.bodies[i].touching = data.bodies[i].has_touched = true;
    }
  });
  touch_trees();
}

void World::Impl::lose(int index) {
  Body& body = data.bodies[index];
  if (body.tree >= 0) return lose_tree(body.tree);
  body.lost = true;
  body.awake = false;
  body.touching = false;
  ++data.lost;
  if (body.simbody_index >= 0) blocks.set_velocity(body.simbody_index, {}, {});
  drop_contacts([&](const Pair& pair) { return pair.body_a == index || pair.body_b == index; });
  if (body.group >= 0) data.lost += int(data.groups[body.group].members.size()) - 1;
  each_collider(body, [&](int i) { data.broad.remove(i); });
}

void World::Impl::remove_lost() {
  for (std::int32_t i : awake_bodies) {
    const Body& body = data.bodies[i];
    if (!body.awake) continue;
    const Vec3 p = body.world_from_type().translation;
    // Written so that a pose that is not a number is lost too.
    const bool inside = p.z >= options.lost_below &&
                        p.x * p.x + p.y * p.y <= options.lost_beyond * options.lost_beyond;
    if (!inside) lose(i);
  }
  lose_ties();
}

void World::Impl::find_contacts() {
  {
    const Stopwatch watch(times.broad);
    wake_marked();
    find_pairs();
    select_pairs();
  }
  const Stopwatch watch(times.narrow);
  update_contacts();
  lead_out();
  wake_hit();
}

void World::Impl::solve() {
  const Stopwatch watch(times.solve);
  apply_forces();
  begin_trees();
  solve_contacts();
}

void World::step() {
  Impl& w = *impl_;
  w.find_contacts();
  w.solve();
  // What broke under these impulses could not give them: who met it meets the parts instead.
  for (int round = 0; round < kMostSplits && w.on_solved && w.on_solved(); ++round) {
    w.find_contacts();
    w.solve();
  }
  {
    const Stopwatch watch(w.times.rest);
    w.update_touching();
    w.clamp_ejection_velocity();
    w.find_rolling();
  }
  {
    const Stopwatch watch(w.times.advance);
    w.advance();
    w.advance_trees();
    w.stretch_ties();
  }
  {
    const Stopwatch watch(w.times.rest);
    w.break_joints();
    w.update_sleep();
    w.remove_lost();
    w.grow_tubes();
  }
  ++w.data.steps;
  if (w.data.verification_steps >= 0) ++w.data.verification_steps;
}

}  // namespace rubble
