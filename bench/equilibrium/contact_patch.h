// Where two convex hulls touch: the judge's own geometry, in double precision, without the kernel's
// narrow phase.
//
// Seen along a normal, the gap between two convex bodies is a convex function, so the region where
// it is at most a tolerance is convex. It is the shadow of what a, moved by the tolerance, has in
// common with b: an intersection of half-spaces, found by clipping the faces of each by the planes
// of the other, without cases of corners, edges and faces.
#pragma once

#include <vector>

#include "bench/true_hull.h"

namespace rubble {

struct RegionPlane {
  Vec3 normal;        // unit length, outwards
  double offset = 0;  // inside: dot(normal, p) <= offset; unit: m
};

// Where half-spaces meet, with those of its faces that bound it.
struct ConvexRegion {
  std::vector<RegionPlane> planes;
  std::vector<std::vector<Vec3>> faces;  // corners in order; unit: m
};
ConvexRegion make_region(const PlacedHull& hull);

// The column over a triangle, from `depth` below its plane up to it.
ConvexRegion make_column(const Vec3 (&triangle)[3], const Vec3& normal, double depth);

// The corners of the region where b, seen from a along `normal` (from a to b, unit length), is at
// most `tolerance` away; each lies midway between the two surfaces. Empty: nowhere.
std::vector<Vec3> find_patch(const ConvexRegion& a, const ConvexRegion& b, const Vec3& normal,
                             double tolerance);

}  // namespace rubble
