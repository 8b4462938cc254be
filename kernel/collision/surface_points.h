// Possible contact points of a convex part with a surface, with the normals of single triangles.
#pragma once

#include <vector>

#include "kernel/collision/surface_contact.h"

namespace rubble {

struct SurfaceGap {
  Vec3f position;        // from the centre of mass of the part's piece, midway between the two; m
  Vec3f normal;          // unit length, out of the surface
  float separation = 0;  // along it; unit: m
};

// All points closer than `margin` on the triangles near the part; `reach`: how far it may move in
// this step.
void find_surface_points(const PosedPart& part, const Vec3& centre, const Aabb& box,
                         const PosedSurface& surface, float margin, float reach,
                         std::vector<SurfaceGap>& points);

}  // namespace rubble
