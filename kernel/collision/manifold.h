// Contact points between two parts along a given normal: the faces that face each other, clipped.
#pragma once

#include <vector>

#include "kernel/collision/sat.h"

namespace rubble {

struct ManifoldPoint {
  Vec3f position;        // in the frame of A's corners, midway between the surfaces
  float separation = 0;  // along the normal
  float predicted = 0;   // at the end of the step, if nothing stops it
  int retained = -1;     // the number that it had in the contact before the search; -1: found anew
  bool known = false;    // whether the contact had it, or one near it, in the step before; see reduce()
};

struct Manifold {
  static constexpr int kMaxClipped = 64;  // a face of 32 corners clipped by one of 32
  ManifoldPoint points[kMaxClipped];      // the first `count` are in use
  int count = 0;                          // range: 0 to kMaxClipped
};

// Clips the incident face against the reference face; keeps points closer than `margin`. Leaves
// nothing when no face looks along the normal (an edge against an edge).
void clip_faces(const PosedPart& a, const PosedPart& b, const Vec3f& offset, const Vec3f& normal,
                float margin, Manifold& manifold);

// Keeps the `most` (at least 4) deepest predicted points. When more than that touch: the deepest
// one, three that span the largest area with it, then by depth. Points that are known are preferred to others about as
// good: a choice that changed from step to step would drop the impulses of points that carry, and stacks would shake.
void reduce(Manifold& manifold, const Vec3f& normal, int most);

}  // namespace rubble
