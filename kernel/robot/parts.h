// Solids that bundled robots are made of: convex parts, masses, looks. Lengths in m, masses in kg.
#pragma once

#include <string>

#include "kernel/model/robot.h"

namespace rubble {

// A box of these full edge lengths.
ConvexPart make_box(const Vec3& size, const Vec3& centre = {});
// A prism over a regular polygon with a facet below, its axis along Y; `radius` to the facets' middles.
ConvexPart make_wheel(double radius, double width, int facets, const Vec3& centre = {});
// Two such prisms of different radii and the hull of both.
ConvexPart make_paddle(double radius_a, double radius_b, double width, int facets, const Vec3& centre_a,
                       const Vec3& centre_b);
// A capsule-like prism along X from x = from to x = to: narrower at the ends, over `narrowing`.
ConvexPart make_tube(double radius, double end_radius, double from, double to, double narrowing,
                     int facets);

// Rings of corners round the X axis, each a polygon with a facet below: `radius` to the facets' middles.
struct Ring {
  double x = 0, radius = 0;
};
ConvexPart make_rings(const std::vector<Ring>& rings, int facets);

// Centre of mass and inertia of the parts, of even density, for a link of that mass.
void set_mass(double mass, RobotLink& link);

// Visual meshes of the bundled robots.
// The link's looks, or where it has none its collision parts in that surface's name.
TriangleMesh make_link_mesh(const RobotLink& link, const std::string& surface);
// Surfaces of the bundled robots: rubber where a belt runs and on wheels, paint or metal elsewhere.
std::string choose_link_surface(const RobotModel& model, std::size_t link);

}  // namespace rubble
