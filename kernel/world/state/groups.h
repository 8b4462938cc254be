// Groups of pieces that form one rigid body and come apart.
//
// The lead of a group is the piece with the lowest number. Its Body has the mass, the pose and the velocities of the
// group. The other pieces keep their numbers, types and colliders, and count as immovable. Pieces keep the orientation in
// which they were bound, so an offset describes each of them. Not for use outside kernel/.
#pragma once

#include <vector>

#include "kernel/world/state/pairs.h"

namespace rubble {

class RigidGroups {
 public:
  RigidGroups(WorldData& data, Bodies& bodies, FreeBodies& blocks, Pairs& pairs)
      : data_(data), bodies_(bodies), blocks_(blocks), pairs_(pairs) {}

  void bind(int first, int count);
  // The same of fixed pieces of equal orientation before their pairs are looked for. free: where the new body
  // is, unless it is fixed.
  void lay(const SplitPart& part, FreeBody* free);
  void split(int lead, const std::vector<SplitPart>& parts);
  void move_fixed(int lead, const Vec3& by);

 private:
  void form(const SplitPart& part, const Body& whole);
  void set_free(const std::vector<SplitPart>& parts, const Body& whole, const Vec3& linear,
                const Vec3& angular);
  void move_contacts(const Vec3& old_centre, int old_lead);

  WorldData& data_;
  Bodies& bodies_;
  FreeBodies& blocks_;
  Pairs& pairs_;
};

}  // namespace rubble
