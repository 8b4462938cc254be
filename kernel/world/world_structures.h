// Rigid bodies of several pieces, and ties between pieces: a structure before and while it breaks.
#pragma once

#include <functional>
#include <vector>

#include "kernel/world/world.h"

namespace rubble {

class World::Structures {
 public:
  // bind() joins fixed pieces with consecutive numbers, scale 1 and equal rotations. They stay fixed until split() frees
  // some. Splitting conserves mass, momentum, angular momentum and energy. `parts` must contain all pieces of the body.
  void bind(int first, int count);
  void split(const std::vector<SplitPart>& parts);
  // Moves the fixed body of a piece, without a speed, as the ground under it moves. What lies near it wakes. unit: m
  void move_fixed(int index, const Vec3& by);
  // All pieces of the rigid body of a piece, ascending.
  std::vector<int> bound_with(int index) const;
  // Of the centre of mass of the rigid body of a piece; unit: m/s.
  Vec3 centre_velocity(int index) const;

  // Ties two pieces that are not links of assemblies. While both are parts of one body, the tie carries no load.
  // Throws InputError for a tie out of range.
  void add_tie(const TieState& tie);
  std::vector<TieState> ties() const;  // unbroken, in the order of their creation
  int tie_count() const;
  double tie_energy() const;           // absorbed by yielding ties so far; unit: J
  // In the last step, by its index in ties(); unit: N.
  double tie_force(int index) const;
  std::vector<ContactLoad> contact_loads() const;  // of all contacts in the last step

  // Called in each step after the contacts were solved and before anything moves. It returns true if it has split a
  // body. Contacts are then found and solved again, at most four times.
  void set_on_solved(std::function<bool()> on_solved);
  // Of contacts and ties at pieces of rigid bodies, also of sleeping ones.
  std::vector<ContactImpulse> contact_impulses() const;

 private:
  friend class World;
  explicit Structures(Impl& world) : impl_(&world) {}

  Impl* impl_;
};

}  // namespace rubble
