// The bodies of a world, their parts and their coordinates. Not for use outside kernel/.
#pragma once

#include <vector>

#include "kernel/multibody/free_bodies.h"
#include "kernel/world/state/world_data.h"

namespace rubble {

class Bodies {
 public:
  Bodies(const WorldTypes& types, WorldData& data, FreeBodies& blocks)
      : types_(types), data_(data), blocks_(blocks) {}

  // Adds a piece by itself. free: receives where one that moves is; see add_to_blocks().
  void add(const NewPiece& piece, FreeBody* free);
  // Gives those from `first` on that move freely their coordinates. free: by body, from `first` on.
  void add_to_blocks(int first, const std::vector<FreeBody>& free);

  void weigh(Body& body) const;                     // a piece alone, by its type
  void weigh(Body& lead, const RigidGroup& group);  // a group; the offsets of its pieces are from anywhere
  void mirror(Body& body);                          // pose and speeds from FreeBodies
  void refresh(Body& body);                         // rotation, inertia, corners and boxes from the pose

  // The body that a piece moves with.
  Body& acting(int piece);
  const Body& acting(int piece) const;
  const Vec3f& reach_of(const Body& body) const;  // largest |x|, |y|, |z| of any corner; unit: m
  double friction_of(std::int32_t collider) const;
  Vec3 linear_velocity(const Body& body) const;   // of the centre of mass; unit: m/s
  Vec3 angular_velocity(const Body& body) const;  // unit: rad/s
  PosedBody posed(const Collider& collider) const;
  std::vector<PosedPart> posed_parts(const Body& body) const;

  // Of a group those of all its members; by number.
  template <typename Action>
  void each_collider(const Body& body, Action&& action) const {
    const auto of = [&action](const Body& piece) {
      for (int i = 0; i < piece.collider_count; ++i) action(piece.first_collider + i);
    };
    if (body.group < 0) return of(body);
    for (const std::int32_t member : data_.groups[body.group].members) of(data_.bodies[member]);
  }

 private:
  void refresh_group(Body& body);

  const WorldTypes& types_;
  WorldData& data_;
  FreeBodies& blocks_;
};

}  // namespace rubble
