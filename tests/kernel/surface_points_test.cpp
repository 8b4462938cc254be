// Where a part touches a surface of triangles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernel/base/random.h"
#include "kernel/collision/body.h"
#include "kernel/collision/surface_points.h"
#include "scenes.h"

namespace rubble {
namespace surface_points_test {

// A single hill of 0.6 m by 0.6 m, four triangles, 0.15 m high, its top in the origin.
Shape hill() {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {-0.3F, -0.3F, -0.15F}, {0.3F, -0.3F, -0.15F}, {0.3F, 0.3F, -0.15F}, {-0.3F, 0.3F, -0.15F}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}};
  Shape shape;
  shape.surface = std::make_shared<const TriangleMeshShape>(mesh);
  return shape;
}

// A beam of 3 m is turned at random and pushed a few millimetres into the hill, so that its edges cross those of the hill. Nothing of
// the surface is farther than 0.3 m away, so no point of contact is: the ends of an edge lead as much as its middle.
TEST(SurfacePoints, LieWhereTheSurfaceIs) {
  const Shape surface = hill(), beam = compile_shape(testing::box_type("beam", 3, 0.3, 0.2), "t");
  Body body;
  body.shape = &surface;
  const PosedSurface posed(body);
  RandomStream random(7, "beams");
  int touching = 0;
  for (int i = 0; i < 3000; ++i) {
    const Quat q = random.rotation();
    const Mat3 m = q.matrix();
    const Mat3f rotation{{Vec3f(m.rows[0]), Vec3f(m.rows[1]), Vec3f(m.rows[2])}};
    std::vector<Vec3f> corners;
    for (const Vec3f& p : beam.parts[0].corners) corners.push_back(rotation * p);
    // Lowered until it would be up to 15 mm too low over the top.
    const Vec3 beside{random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), 0};
    const auto holds_top = [&](double z) {
      const Vec3 local = m.transposed() * (-(beside + Vec3{0, 0, z}));
      return std::abs(local.x) < 1.5 && std::abs(local.y) < 0.15 && std::abs(local.z) < 0.1;
    };
    double height = 0;
    while (holds_top(height)) height += 0.001;
    const Vec3 centre = beside + Vec3{0, 0, height - random.uniform(0, 0.015)};
    Aabb box{centre, centre};
    for (const Vec3f& p : corners) box.min = min(box.min, centre + Vec3(p)), box.max = max(box.max, centre + Vec3(p));
    std::vector<SurfaceGap> points;
    find_surface_points({&beam.parts[0], {corners.data(), int(corners.size())}, &rotation}, centre, box, posed, 0.02F, 0, points);
    touching += !points.empty();
    for (const SurfaceGap& p : points) {
      const Vec3 at = Vec3(p.position) + centre;
      const double room = 0.3 + 0.5 * std::abs(double(p.separation)) + 0.005;
      EXPECT_LE(std::max(std::abs(at.x), std::abs(at.y)), room) << i << ", separation " << p.separation;
    }
  }
  EXPECT_GT(touching, 2000);
}

}  // namespace surface_points_test
}  // namespace rubble
