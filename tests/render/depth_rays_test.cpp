// Depth pictures by rays against the rays of LiDARs, one at a time.
#include "render/rays/depth_rays.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/render/test_scene.h"

namespace rubble::testing {
namespace depth_rays_test {

// Pictures of all shapes are cast in tiles of pixels; a pixel knows nothing of its tile.
TEST(DepthRays, ArePixelForPixelThoseOfSingleRays) {
  const RayWorld world(make_heap(60, 5));
  const Pose eye = look_at({-3, 0.3, 1.1}, {0, 0, 0.4});
  constexpr double kReach = 4;
  for (const auto& [width, height] : {std::pair(16, 12), std::pair(7, 5), std::pair(1, 1), std::pair(33, 2)}) {
    const DepthRays rays(pinhole(width, height, 12), kReach);
    const std::size_t pixels = std::size_t(width) * std::size_t(height);
    std::vector<float> depth(pixels, -1), again(pixels, -1);
    std::vector<std::int32_t> pieces(pixels, -7);
    ThreadPool one(1), three(3);
    rays.cast(world, eye, one, depth.data(), pieces.data());
    rays.cast(world, eye, three, again.data());
    EXPECT_EQ(depth, again);
    for (std::size_t i = 0; i < pixels; ++i) {
      const RayWorld::Ray ray{eye.translation, eye.rotation.matrix() * rays.direction(i), 0};
      RayWorld::Hit hit;
      world.cast(&ray, 1, kReach, &hit);
      ASSERT_EQ(pieces[i], hit.piece) << width << " wide, pixel " << i;
      if (hit.distance < 0) {
        ASSERT_TRUE(std::isinf(depth[i]));
      } else {
        ASSERT_EQ(depth[i], float(hit.distance * rays.cosine(i))) << width << " wide, pixel " << i;
      }
    }
    const auto is_of = [&](auto&& what) { return std::count_if(pieces.begin(), pieces.end(), what); };
    if (width < 16) continue;
    EXPECT_GT(is_of([](std::int32_t piece) { return piece >= 0; }), 5) << "the picture shows nothing";
  }
}

}  // namespace depth_rays_test
}  // namespace rubble::testing
