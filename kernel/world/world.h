// The physics: pieces under gravity over the ground z = 0, advanced in fixed steps.
//
// settle_pile() is a schedule on top of it; tests and benchmarks use it directly. Lengths in metres, masses in kg,
// times in s. Pieces are numbered in the order of their addition; numbers never change.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "kernel/model/pile.h"
#include "kernel/model/pile_state.h"
#include "kernel/model/world_input.h"

namespace rubble {

// Impulse on a piece at one point of a contact in the last solution, mean over the step.
struct ContactImpulse {
  int piece = 0;
  int other = -1;           // the other piece; -1: the ground
  Vec3 point;           // unit: m
  Vec3 impulse;         // on the piece; unit: N s
  double approach = 0;  // closing speed along the normal before the step; unit: m/s
};

class World {
 public:
  // Throws InputError for a type or assembly with invalid geometry, material or joints.
  World(std::vector<PieceType> types, const WorldOptions& options = {},
        std::vector<AssemblyType> assemblies = {});
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  // Adds pieces as a group; returns the number of the first one. An assembly gives as many pieces as
  // it has links, in their order. Throws InputError when a type does not exist or a scale is out of
  // range.
  int add(const std::vector<NewPiece>& pieces);

  // Puts a settled pile into an empty world with the pile's types and assemblies. Pieces keep their numbers and poses,
  // and are asleep, with their joints. Rigid bodies and ties of a collapsed building are restored; these bodies do not
  // break again. The loads of contacts are found by half a second with all pieces awake. fixed: the pile never moves.
  // Throws InputError for a state of another pile.
  void lay(const Pile& pile, const PileState& state, bool fixed = false);

  void step();
  // Changes the length of later steps, e.g. when robots are added to a settled pile. Impulses of sleeping pieces are
  // scaled. substeps: of the contact solver; range: 1 to 64. Throws InputError for a step out of range.
  void set_step(double step, int substeps);

  // Adds an immovable surface with a type of its own, such as a street around the pile. It collides by its triangles,
  // from their front side. Returns its number. mesh: in the world; unit: m. friction: Coulomb, against concrete;
  // range: 0 to 2. Throws InputError for a mesh without area.
  int add_surface(std::shared_ptr<const TriangleMesh> mesh, double friction);

  // What else a world does, by what is asked of it, each in a header of its own. These objects refer to the world, which
  // must outlive them.
  class Robots;
  class Structures;
  class Rest;
  class Diagnostics;
  Robots robots();  // world_robots.h
  const Robots robots() const;
  Structures structures();  // world_structures.h: bodies of several pieces, ties, impulses of their contacts
  const Structures structures() const;
  Rest rest();  // world_rest.h
  const Rest rest() const;
  Diagnostics diagnostics();  // world_diagnostics.h: overlaps, energies, momenta, stages
  const Diagnostics diagnostics() const;

  int size() const;
  int awake_count() const;
  int lost_count() const;
  std::int64_t steps() const;
  double time() const;  // simulated; unit: s

  PieceState piece(int index) const;
  std::vector<PieceState> pieces() const;  // all, in their order
  Vec3 centre_of_mass(int index) const;  // in the frame of the piece's type, scaled; unit: m
  bool is_awake(int index) const;
  bool is_touching(int index) const;  // whether it had a contact in the last step
  // Sets the velocities of a piece and wakes it. Immovable pieces do not change. A link moves its whole tree as one
  // rigid body, unless the root is immovable.
  void set_velocity(int index, const Vec3& linear, const Vec3& angular);
  // An impulse on a piece at a point of the world; wakes it. A link passes it on to its tree, pieces of a rigid body to the
  // body. No effect on what is immovable or lost. unit: N s, m
  void apply_impulse(int index, const Vec3& point, const Vec3& impulse);
  // Change of the velocity of a piece at that point by an impulse of 1 N s there along X, Y, Z, as columns. Zero for what
  // is immovable or lost. unit: 1/kg
  Mat3 impulse_response(int index, const Vec3& point) const;
  // Moves a piece and wakes it and its neighbours; links as above.
  void set_pose(int index, const Pose& world_from_body);
  void wake_all();
  void set_sleeping(bool allowed);  // wakes all when false

  std::vector<JointState> joints() const;  // unbroken
  // Of all contacts with an impulse in the last solution, once each: on the second of two pieces, or on the piece that
  // lies on the ground. Those between sleeping pieces are as they were when these fell asleep.
  std::vector<ContactImpulse> contacts() const;
  double mass(int index) const;            // 0: immovable

  // All data that later steps depend on, except options and threads. A restored snapshot continues with the same bits,
  // in any world with the same types (RunError otherwise), also in an empty one. kernel/world/world_snapshot.h converts
  // snapshots to bytes and back.
  struct Snapshot;
  std::shared_ptr<const Snapshot> snapshot() const;
  void restore(const Snapshot& snapshot);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rubble
