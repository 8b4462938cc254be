#include "kernel/robot/parts.h"

#include "kernel/base/portable_math.h"
#include "kernel/geometry/hull.h"
#include "kernel/geometry/shape.h"

namespace rubble {
namespace {

// Corners of a polygon with a facet at -Z, in the plane of X and Z.
Vec3 polygon_corner(double apothem, int facets, int k) {
  const double half = portable::kPi / facets;
  const auto [s, c] = portable::sincos((2 * k + 1) * half - 0.5 * portable::kPi);
  const double radius = apothem / portable::cos(half);
  return {radius * c, 0, radius * s};
}

void add_wheel(double radius, double width, int facets, const Vec3& centre, ConvexPart& part) {
  for (int k = 0; k < facets; ++k) {
    const Vec3 corner = centre + polygon_corner(radius, facets, k);
    part.points.push_back(corner + Vec3{0, -0.5 * width, 0});
    part.points.push_back(corner + Vec3{0, 0.5 * width, 0});
  }
}

}  // namespace

ConvexPart make_box(const Vec3& size, const Vec3& centre) {
  ConvexPart part;
  for (int k = 0; k < 8; ++k) {
    const Vec3 corner{(k & 1) != 0 ? 0.5 : -0.5, (k & 2) != 0 ? 0.5 : -0.5, (k & 4) != 0 ? 0.5 : -0.5};
    part.points.push_back(centre + Vec3{corner.x * size.x, corner.y * size.y, corner.z * size.z});
  }
  return part;
}

ConvexPart make_wheel(double radius, double width, int facets, const Vec3& centre) {
  ConvexPart part;
  add_wheel(radius, width, facets, centre, part);
  return part;
}

ConvexPart make_paddle(double radius_a, double radius_b, double width, int facets,
                       const Vec3& centre_a, const Vec3& centre_b) {
  ConvexPart part;
  add_wheel(radius_a, width, facets, centre_a, part);
  add_wheel(radius_b, width, facets, centre_b, part);
  return part;
}

ConvexPart make_tube(double radius, double end_radius, double from, double to, double narrowing,
                     int facets) {
  return make_rings({{from, end_radius}, {from + narrowing, radius}, {to - narrowing, radius}, {to, end_radius}},
                    facets);
}

ConvexPart make_rings(const std::vector<Ring>& rings, int facets) {
  ConvexPart part;
  for (const Ring& ring : rings) {
    for (int k = 0; k < facets; ++k) {
      const Vec3 c = polygon_corner(ring.radius, facets, k);
      part.points.push_back({ring.x, c.x, c.z});
    }
  }
  return part;
}

void set_mass(double mass, RobotLink& link) {
  PieceType type;
  type.parts = link.parts;
  const VolumeProperties volume = compile_shape(type, link.name).volume;
  link.mass = mass;
  link.centre_of_mass = volume.centre_of_mass;
  link.inertia = volume.inertia * (mass / volume.volume);
}

TriangleMesh make_link_mesh(const RobotLink& link, const std::string& surface) {
  if (!link.looks.triangles.empty()) return link.looks;
  TriangleMesh mesh;
  mesh.surface_names = {surface};
  for (const ConvexPart& part : link.parts) {
    const Hull hull = calc_hull(part.points);
    for (const std::vector<int>& face : hull.faces) {
      // Corners of its own for each face: its edges are sharp.
      const std::uint32_t first = std::uint32_t(mesh.positions.size());
      for (int corner : face) mesh.positions.push_back(Vec3f(hull.points[std::size_t(corner)]));
      for (std::uint32_t k = 2; k < face.size(); ++k) {
        mesh.triangles.push_back({first, first + k - 1, first + k});
        mesh.surfaces.push_back(0);
      }
    }
  }
  return mesh;
}

std::string choose_link_surface(const RobotModel& model, std::size_t index) {
  const RobotLink& link = model.links[index];
  if (norm(link.belt_axis) > 0 || link.name.find("wheel") != std::string::npos) return "rubber";
  if (index == 0) return "car_paint";
  return "steel_galvanised";
}

}  // namespace rubble
