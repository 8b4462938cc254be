// Flat convex polygons in space, and convex bodies as the common part of half-spaces.
#pragma once

#include <vector>

#include "kernel/base/math.h"

namespace rubble {

// The side of a plane where dot(normal, p) <= offset.
struct HalfSpace {
  Vec3 normal;        // unit length, outwards
  double offset = 0;  // unit: m
};

// Counter-clockwise seen from the tip of its normal; empty when nothing is left of it.
using Polygon = std::vector<Vec3>;

Polygon clip(const Polygon& polygon, const HalfSpace& half_space);
// The part of a half-space's plane that the others leave; empty when the plane misses them. It must not
// reach farther than `extent` from the origin; unit: m.
Polygon cut_plane(const HalfSpace& plane, const std::vector<HalfSpace>& others, double extent);

// Two unit axes that span a plane with its normal: s, t, normal is right-handed. t is the world's
// upward direction laid into the plane, or its Y where the normal is vertical.
struct PlaneAxes {
  Vec3 s, t;  // unit length, in the world
};
PlaneAxes make_axes(const Vec3& normal);

struct AreaProperties {
  double area = 0;                     // unit: m2
  Vec3 centroid;                       // unit: m
  double inertia_s = 0, inertia_t = 0;  // second moments about s and t through the centroid; unit: m4
  double half_s = 0, half_t = 0;  // how far it reaches from there along s and t; unit: m
};
AreaProperties calc_area_properties(const Polygon& polygon, const PlaneAxes& axes);

}  // namespace rubble
