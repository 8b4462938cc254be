#include "kernel/base/mesh.h"

#include <gtest/gtest.h>

namespace rubble {
namespace mesh_test {

// An axis-aligned box from `low` to `high`, triangles outwards.
TriangleMesh make_box(const Vec3f& low, const Vec3f& high) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.positions.push_back({i & 1 ? high.x : low.x, i & 2 ? high.y : low.y,
                              i & 4 ? high.z : low.z});
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

TEST(VolumeProperties, MatchTheClosedFormOfABox) {
  const VolumeProperties v = calc_volume_properties(make_box({1, 2, 3}, {3, 3, 6}));
  EXPECT_NEAR(v.volume, 6.0, 1e-12);
  EXPECT_LT(distance(v.centre_of_mass, {2, 2.5, 4.5}), 1e-12);
  EXPECT_NEAR(v.inertia.rows[0].x, 6.0 * (1 + 9) / 12, 1e-11);
  EXPECT_NEAR(v.inertia.rows[1].y, 6.0 * (4 + 9) / 12, 1e-11);
  EXPECT_NEAR(v.inertia.rows[2].z, 6.0 * (4 + 1) / 12, 1e-11);
  EXPECT_NEAR(v.inertia.rows[0].y, 0.0, 1e-11);
}

TEST(IsClosed, NoticesAMissingTriangle) {
  TriangleMesh mesh = make_box({0, 0, 0}, {1, 1, 1});
  EXPECT_TRUE(is_closed(mesh));
  mesh.triangles.pop_back();
  EXPECT_FALSE(is_closed(mesh));
}

}  // namespace mesh_test
}  // namespace rubble
