// The inside of World: its data and the stages of a step. Not for use outside kernel/.
#pragma once

#include <unordered_map>
#include <vector>

#include "kernel/base/parallel.h"
#include "kernel/body.h"
#include "kernel/broad_phase.h"
#include "kernel/contact.h"
#include "kernel/contact_solver.h"
#include "kernel/narrow_phase.h"
#include "kernel/simbody_blocks.h"
#include "kernel/world.h"

namespace rubble {

// What a snapshot holds: all that changes from step to step.
struct WorldData {
  std::vector<Body> bodies;
  std::vector<Collider> colliders;
  std::vector<Vec3f> corners;  // turned to the world, from the centre of mass of their piece
  BroadPhase broad;
  std::vector<Pair> pairs;        // of parts that are near each other
  std::vector<Contact> contacts;  // one per pair
  std::unordered_map<std::uint64_t, std::int32_t> contact_of_pair;  // looked up, never walked
  std::vector<std::uint8_t> wake_next;                              // by body
  std::int64_t steps = 0;
  std::int64_t proof_steps = -1;  // since prove_rest(); -1: not called since pieces were added
  int lost = 0;
};

struct World::Impl {
  Impl(std::vector<PieceType> piece_types, const WorldOptions& world_options);

  std::vector<PieceType> types;
  std::vector<Shape> shapes;
  WorldOptions options;
  SolverSettings solver_settings;
  NarrowSettings narrow_settings;
  ThreadPool pool;
  WorldData data;
  SimbodyBlocks blocks;
  ContactSolver solver;
  StepTimes times;

  // Scratch of a step.
  std::vector<std::int32_t> active;
  std::vector<std::uint8_t> moves;  // by number in SimbodyBlocks
  std::vector<Motion> velocities, displacements;
  std::vector<BodyRates> rates;  // by number in SimbodyBlocks
  std::vector<float> fastest;

  // world.cpp
  void add_body(const NewPiece& piece, FreeBody* free);
  void mirror(Body& body);   // q and u from Simbody
  void refresh(Body& body);  // rotation, inertia, corners, boxes
  PosedBody posed(const Collider& collider) const;

  // world_pairs.cpp
  void find_pairs();
  void select_pairs();
  void update_contacts();
  bool may_touch(const Pair& pair) const;
  void add_contact(int collider_a, int collider_b);
  void remove_contact(std::size_t index);

  // world_sleep.cpp
  void wake_marked();
  void wake_hit();
  void update_sleep();
  void wake_changed();
  std::vector<std::uint8_t> find_overlapping() const;  // by body: 1 where it overlaps too deep
  void note_loads(const std::vector<std::uint8_t>& slept);
  void wake(int body);
  void fall_asleep(int body);
  float wake_impulse(const Body& body) const;  // a contact's must change by this; unit: N s

  // world_step.cpp
  void apply_forces();
  void solve_contacts();
  void sort_by_height();
  void update_touching();
  void limit_kicks();
  void advance();
  void set_rates(std::size_t body);
  double calc_travel(const Body& body) const;
  void remove_lost();
  void lose(int body);
};

// Its members, like those of WorldData and what it holds, are listed in world_fields.h as well.
struct World::Snapshot {
  std::uint64_t types = 0;  // hash_types() of the world's types
  WorldData data;
  std::vector<FreeBody> simbody;           // by number in SimbodyBlocks
  std::vector<std::int32_t> block_starts;  // number of each block's first body
};

}  // namespace rubble
