// From two posed parts to contact points.
#pragma once

#include "kernel/collision/body.h"
#include "kernel/collision/contact.h"
#include "kernel/collision/sat.h"

namespace rubble {

// One side of a contact for the narrow phase.
struct PosedBody {
  PosedPart part;         // corners relative to `centre`
  Vec3 centre;            // centre of mass in the world; unit: m
  Vec3f linear, angular;  // velocities; unit: m/s, rad/s
};

struct NarrowSettings {
  float margin = 0.02F;  // make points up to this separation, plus what the motion of a step adds
  float step = 1.0F / 60;  // unit: s
};

// Points that stay farther apart than this are left out: more than gravity closes in a step and the
// change of speed by other contacts usually does; unit: m.
inline constexpr float kPointMargin = 0.010F;

// The fixed margin and what two may come together in one step. relative: linear velocity; turning:
// sum of the angular speeds times radius; unit: m/s.
float motion_margin(const Vec3f& relative, float turning, const NarrowSettings& settings);
void clear_points(Contact& contact);

struct Manifold;
// Writes points against something immovable into the contact; those found again keep their impulses.
void store_points(Contact& contact, Manifold& manifold, const Vec3f& normal, const PosedBody& a);

// Finds normal and points anew, and carries over the impulses of points found again. No points:
// the parts are farther apart than they can come in this step; then returns a distance that they
// keep at least, else 0; unit: m. free: nothing touches either, and neither is a tree's link; then fast ones are searched
// where they will meet.
float update_contact(Contact& contact, const PosedBody& a, const PosedBody& b, float margin,
                    const NarrowSettings& settings, bool free = false);
// Finds the points along a given normal (unit length, from A to B) of two parts that overlap along it
// and have points already.
void search_along(Contact& contact, const PosedBody& a, const PosedBody& b, const Vec3f& normal,
                  float margin, const NarrowSettings& settings);
// Moves the points along with two parts that have hardly moved since the last search.
void follow_contact(Contact& contact, const PosedBody& a, const PosedBody& b);
// The same against the ground, z = 0.
void update_ground_contact(Contact& contact, const PosedBody& a, float margin,
                           const NarrowSettings& settings);

}  // namespace rubble
