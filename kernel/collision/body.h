// A piece as the kernel sees it between two steps. FreeBodies or Simbody holds q and u; the fields here mirror
// them in the form that contacts need.
#pragma once

#include <cstdint>

#include "kernel/base/math.h"
#include "kernel/geometry/shape.h"

namespace rubble {

struct Body {
  // What it is.
  std::int32_t type = 0, layer = 0;
  double scale = 1;  // of the shape's lengths; above 0
  const Shape* shape = nullptr;  // at scale 1; must outlive the body
  double mass = 0;              // unit: kg; 0: immovable
  Vec3 com_in_type;             // centre of mass in the scaled frame of the type; unit: m
  Mat3 inertia;                 // about the centre of mass, in the body; unit: kg m2
  Mat3f inverse_inertia_local;  // unit: 1/(kg m2)
  float inverse_mass = 0;       // unit: 1/kg
  float radius = 0;             // about the centre of mass, scaled; unit: m
  std::int32_t free_index = -1;     // its number in FreeBodies; -1: immovable, or a tree's link
  std::int32_t tree = -1;       // the articulated tree that it is a link of; -1: none
  std::int32_t link = -1;       // its number there
  std::int32_t first_collider = 0, collider_count = 0;  // of the piece itself
  // Pieces that hold together move as the first of them, the lead; see kernel/world/state/groups.h.
  std::int32_t lead = -1;       // the piece that this one moves with, itself where it leads; -1: none
  std::int32_t group = -1;      // of a lead: its number among the groups
  Vec3 origin_in_group;         // of the type's frame, from the group's centre of mass; unit: m

  // Where it is, mirrored after each step.
  Pose world_from_com;
  Vec3f linear, angular;        // unit: m/s, rad/s
  Mat3f rotation;               // world from body
  Mat3f inverse_inertia;        // in the world
  double travel = 0;            // no point of it has gone farther than this so far; unit: m

  // Sleeping: it must stay within a small distance of a pose for a while, or within a larger one of
  // another pose for longer.
  Pose still_pose, loose_pose;
  std::int32_t still_steps = 0, loose_steps = 0;  // in a row near still_pose, near loose_pose
  // A later place of it, for when it leaves the second pose; while rest is verified only.
  Pose later_pose;
  std::int32_t later_steps = 0;
  // Sums over its contacts in the step when it fell asleep: normal impulses, and what friction may give. unit: N s
  float load = 0, grip = 0;
  Vec3f lost_support;  // impulses of a step that contacts gave it then and that are gone; unit: N s

  bool awake = false;    // moves; never true for immovable pieces
  bool lost = false;  // it left the world and takes no part any more
  bool touching = false;      // in contact now
  bool has_touched = false;   // ever

  bool movable() const { return mass > 0 && !lost; }
  Pose world_from_type() const {
    return {world_from_com.rotation,
            world_from_com.translation - world_from_com.rotation.rotate(com_in_type)};
  }
};

// One convex part of a body in the broad phase.
struct Collider {
  std::int32_t body = 0, part = 0;  // the body that it moves with
  std::int32_t piece = 0;           // the one whose part it is: another where pieces hold together
  std::int32_t first_corner = 0;  // into the world's array of turned corners
  Aabb box;                       // at the last step it moved
};

}  // namespace rubble
