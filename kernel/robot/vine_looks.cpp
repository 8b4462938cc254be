#include "kernel/robot/vine_looks.h"

#include <cmath>
#include <string>
#include <vector>

#include "kernel/base/portable_math.h"
#include "kernel/robot/parts.h"

namespace rubble {
namespace {

constexpr int kLooksFacets = 28;

// Adds parts to a mesh, each with a surface of its own.
class LooksBuilder {
 public:
  // A surface round the X axis of `at` through rings from back to front; smooth along it.
  void add_revolution(const std::vector<Ring>& rings, const std::string& surface, const Pose& at = {}) {
    const std::uint32_t first = count();
    for (std::size_t i = 0; i < rings.size(); ++i) {
      const Ring &a = rings[i > 0 ? i - 1 : 0], &b = rings[std::min(i + 1, rings.size() - 1)];
      const double length = std::sqrt((b.x - a.x) * (b.x - a.x) + (b.radius - a.radius) * (b.radius - a.radius));
      const double along = -(b.radius - a.radius) / length, outwards = (b.x - a.x) / length;
      for (int k = 0; k < kLooksFacets; ++k) {
        const auto [s, c] = portable::sincos(2 * portable::kPi * k / kLooksFacets);
        add_vertex(at, {rings[i].x, rings[i].radius * c, rings[i].radius * s},
                   {along, outwards * c, outwards * s});
      }
    }
    for (std::uint32_t i = 0; i + 1 < rings.size(); ++i) {
      for (std::uint32_t k = 0; k < kLooksFacets; ++k) {
        const std::uint32_t next = (k + 1) % kLooksFacets, a = first + i * kLooksFacets,
                            b = a + kLooksFacets;
        add_triangle({a + k, a + next, b + next}, surface);
        add_triangle({a + k, b + next, b + k}, surface);
      }
    }
  }

  // The disc at x, facing along +X (or -X) of `at`.
  void add_disc(double x, double radius, bool forwards, const std::string& surface, const Pose& at = {}) {
    const std::uint32_t first = count();
    const Vec3 normal{forwards ? 1.0 : -1.0, 0, 0};
    for (int k = 0; k < kLooksFacets; ++k) {
      const auto [s, c] = portable::sincos(2 * portable::kPi * k / kLooksFacets);
      add_vertex(at, {x, radius * c, radius * s}, normal);
    }
    for (std::uint32_t k = 2; k < kLooksFacets; ++k) {
      if (forwards) add_triangle({first, first + k - 1, first + k}, surface);
      if (!forwards) add_triangle({first, first + k, first + k - 1}, surface);
    }
  }

  void add_box(const Vec3& size, const Vec3& centre, const std::string& surface) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {-1.0, 1.0}) {
        Vec3 n, u, v;
        n[axis] = side;
        u[(axis + 1) % 3] = 0.5 * size[(axis + 1) % 3];
        v[(axis + 2) % 3] = side * 0.5 * size[(axis + 2) % 3];
        const Vec3 middle = centre + n * (0.5 * size[axis]);
        const std::uint32_t first = count();
        for (const Vec3& corner : {middle - u - v, middle + u - v, middle + u + v, middle - u + v}) {
          add_vertex({}, corner, n);
        }
        add_triangle({first, first + 1, first + 2}, surface);
        add_triangle({first, first + 2, first + 3}, surface);
      }
    }
  }

  TriangleMesh mesh;

 private:
  std::uint32_t count() const { return std::uint32_t(mesh.positions.size()); }
  void add_vertex(const Pose& at, const Vec3& position, const Vec3& normal) {
    mesh.positions.push_back(Vec3f(at * position));
    mesh.normals.push_back(Vec3f(at.rotation.rotate(normal)));
  }
  void add_triangle(const std::array<std::uint32_t, 3>& corners, const std::string& surface) {
    std::size_t i = 0;
    while (i < mesh.surface_names.size() && mesh.surface_names[i] != surface) ++i;
    if (i == mesh.surface_names.size()) mesh.surface_names.push_back(surface);
    mesh.triangles.push_back(corners);
    mesh.surfaces.push_back(std::uint8_t(i));
  }
};

// Takes X to Y.
Pose sideways(const Vec3& centre) { return {{0.7071067811865476, 0, 0, 0.7071067811865476}, centre}; }

}  // namespace

// A case with a drum for the reel across its back, a fan on one side and a collar round the mouth.
TriangleMesh make_vine_base_looks(double r) {
  LooksBuilder b;
  b.add_box({6 * r, 4.4 * r, 4 * r}, {-3 * r, 0, r}, "car_paint");
  b.add_box({6.1 * r, 4.5 * r, 0.25 * r}, {-3 * r, 0, -0.87 * r}, "rubber");
  for (const double side : {-1.0, 1.0}) {
    const Pose hub = sideways({-3.6 * r, side * 2.2 * r, r});
    b.add_revolution({{-0.3 * r, 1.5 * r}, {0.3 * r, 1.5 * r}}, "steel_galvanised", hub);
    b.add_disc(side * 0.3 * r, 1.5 * r, side > 0, "steel_galvanised", hub);
    b.add_revolution({{-0.45 * r, 0.5 * r}, {0.45 * r, 0.5 * r}}, "rubber", hub);
    b.add_disc(side * 0.45 * r, 0.5 * r, side > 0, "rubber", hub);
  }
  b.add_revolution({{-0.2 * r, 1.35 * r}, {0.25 * r, 1.35 * r}, {0.35 * r, 1.25 * r}}, "steel_galvanised");
  b.add_disc(0.35 * r, 1.25 * r, true, "rubber");
  return b.mesh;
}

// Coated cloth with a welded seam round each link. Its ends reach into its neighbours, so that bends are
// closed.
TriangleMesh make_vine_tube_looks(double r, double length) {
  LooksBuilder b;
  const double wall = 0.985 * r, seam = 0.06 * length, end = 0.35 * r;
  b.add_revolution({{-end, 0.86 * wall}, {-0.5 * end, 0.95 * wall}, {0, wall}, {0.5 * length - seam, wall}}, "fabric");
  b.add_revolution({{0.5 * length - seam, 0.98 * wall}, {0.5 * length - 0.9 * seam, 0.995 * r},
                    {0.5 * length + 0.9 * seam, 0.995 * r}, {0.5 * length + seam, 0.98 * wall}}, "rubber");
  b.add_revolution({{0.5 * length + seam, wall}, {length, wall}, {length + 0.5 * end, 0.95 * wall},
                    {length + end, 0.86 * wall}}, "fabric");
  return b.mesh;
}

// A sleeve of a link's length, under which the next links are folded, the turning wall in front of it, and a
// lamp ring with a camera in its middle.
TriangleMesh make_vine_tip_looks(double r, double length) {
  LooksBuilder b;
  const double back = -1.02 * length;
  b.add_disc(back, 1.06 * r, false, "rubber");
  b.add_revolution({{back, 1.06 * r}, {back + 0.12 * r, 1.1 * r}, {0.1 * r, 1.1 * r}, {0.2 * r, 1.02 * r}},
                   "car_paint");
  b.add_revolution({{0.05 * r, r}, {0.3 * r, 0.96 * r}, {0.55 * r, 0.84 * r}, {0.78 * r, 0.63 * r},
                    {0.9 * r, 0.44 * r}},
                   "fabric");
  b.add_revolution({{0.6 * r, 0.46 * r}, {0.96 * r, 0.46 * r}}, "steel_galvanised");
  b.add_disc(0.96 * r, 0.46 * r, true, "steel_galvanised");
  b.add_revolution({{0.95 * r, 0.24 * r}, {1.02 * r, 0.24 * r}}, "rubber");
  b.add_disc(1.02 * r, 0.24 * r, true, "glass");
  return b.mesh;
}

}  // namespace rubble
