#include "render/camera/culling.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/devices/gl/gl_device.h"
#include "render/devices/software/software_device.h"
#include "render/renderer.h"
#include "tests/render/cached_options.h"
#include "tests/render/test_scene.h"

namespace rubble::testing {
namespace culling_test {

RenderOptions options_with(bool culling) {
  RenderOptions options = cached_options();
  options.bake = false;
  options.shadow_size = 256;
  options.texture_size = 32;
  options.occlusion_culling = culling;
  return options;
}

// What is hidden may be left out, but nothing that shows: the same pieces and depths with and
// without, along a path with large steps so that the memory of the frame before is often wrong.
void check_that_nothing_is_dropped(Device& device, const Intrinsics& k) {
  const Scene heap = make_heap(500, 3);
  Renderer with(device, heap, options_with(true)), without(device, heap, options_with(false));
  const Vec3 eyes[] = {{7, 2, 1.5}, {4, 0.3, 0.7}, {1, 0, 0.6}, {-1, 0.2, 0.5},
                       {-6, -4, 3}, {0.2, 0.1, 5}, {1, 0, 0.6}};
  const Vec3 targets[] = {{0, 0, 1}, {0, 0, 0.6}, {-1.5, 0.5, 0.6}, {3, 0, 0.6},
                          {0, 0, 1}, {0, 0, 0},   {4, 0.5, 0.4}};
  for (std::size_t i = 0; i < 7; ++i) {
    const Pose pose = look_at(eyes[i], targets[i]);
    const LinearFrame a = with.render_linear(pose, k), b = without.render_linear(pose, k);
    std::size_t different_depth = 0, different_piece = 0;
    for (std::size_t p = 0; p < a.depth.size(); ++p) {
      const bool same =
          a.depth[p] == b.depth[p] || (std::isnan(a.depth[p]) && std::isnan(b.depth[p]));
      different_depth += !same;
      different_piece += a.instance[p] != b.instance[p];
    }
    EXPECT_EQ(different_depth, 0u) << "pose " << i;
    // Where two pieces have the very same depth, either may win.
    EXPECT_LE(different_piece, 3u) << "pose " << i;
  }
}

TEST(OcclusionCulling, NeverDropsWhatShows) {
  SoftwareDevice software;
  check_that_nothing_is_dropped(software, pinhole(320, 240, 200));
  GlDevice gl;
  check_that_nothing_is_dropped(gl, pinhole(186, 143, 120));
}

void check_that_most_is_left_out(Device& device) {
  const Scene heap = make_heap(500, 3);
  Renderer with(device, heap, options_with(true)), without(device, heap, options_with(false));
  const Pose pose = look_at({1, 0, 0.6}, {-1.5, 0, 0.5});
  const Intrinsics k = pinhole(320, 240, 200);
  const auto triangles = [&](Renderer& renderer, std::int64_t stamp_ns) {
    RenderedView view = renderer.view({stamp_ns, k, pose});
    view.depth();
    return view.times().triangles;
  };
  triangles(with, 0);
  EXPECT_LT(triangles(with, 1) * 3, triangles(without, 0));
}

TEST(OcclusionCulling, LeavesMostOfAHeapOut) {
  SoftwareDevice software;
  check_that_most_is_left_out(software);
  GlDevice gl;
  check_that_most_is_left_out(gl);
}

TEST(DepthPyramid, HidesOnlyWhatIsBehindAllOfARectangle) {
  std::vector<float> depth(100 * 60, 0.5f);
  depth[30 * 100 + 50] = 0.1f;  // a farther spot
  DepthPyramid pyramid;
  pyramid.build(depth.data(), 100, 60);
  EXPECT_FALSE(pyramid.may_show(0, 0, 20, 20, 0.4f));
  EXPECT_TRUE(pyramid.may_show(0, 0, 20, 20, 0.6f));
  EXPECT_TRUE(pyramid.may_show(40, 20, 60, 40, 0.4f));
  EXPECT_TRUE(pyramid.may_show(0, 0, 99, 59, 0.4f));
  EXPECT_FALSE(pyramid.may_show(0, 0, 99, 59, 0.05f));
}

TEST(ViewVolume, SeesSpheresThatTouchTheImage) {
  const ViewProjection view({}, pinhole(100, 100, 50));  // 90 degrees wide
  const ViewVolume volume(view);
  EXPECT_TRUE(volume.sphere_in_view({0, 0, 5}, 0.1f));
  EXPECT_FALSE(volume.sphere_in_view({0, 0, -5}, 0.1f));
  EXPECT_TRUE(volume.sphere_in_view({5.5f, 0, 5}, 0.5f));
  EXPECT_FALSE(volume.sphere_in_view({6.5f, 0, 5}, 0.5f));
  EXPECT_TRUE(volume.sphere_in_view({0, 0, -0.3f}, 0.5f));
}

TEST(FacesAway, OnlyWhenAllOfTheConeDoes) {
  const Vec3f up(0, 0, 1);
  EXPECT_TRUE(faces_away({0, 0, -5}, {}, 0.1f, up, 0.95f));
  EXPECT_FALSE(faces_away({0, 0, 5}, {}, 0.1f, up, 0.95f));
  EXPECT_FALSE(faces_away({5, 0, -0.5f}, {}, 0.1f, up, 0.95f));
  EXPECT_FALSE(faces_away({0, 0, -5}, {}, 0.1f, up, -1));
}

}  // namespace culling_test
}  // namespace rubble::testing
