// The penumbra of the sun's disc in fast pictures, against its closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "kernel/base/portable_math.h"
#include "render/devices/gl/gl_device.h"
#include "render/devices/software/software_device.h"
#include "render/lighting/lighting.h"
#include "render/passes/shadow_views.h"
#include "render/renderer.h"
#include "tests/render/cached_options.h"
#include "tests/render/test_scene.h"

namespace rubble::testing {
namespace sun_shadow_test {

constexpr double kElevation = 60 * portable::kPi / 180;
constexpr double kSlab = 0.01;  // thickness of what throws the shadow; unit: m

// A floor, and over it a slab whose straight upper edge is that high, over x = 0. The sun shines along +X.
Scene edge_scene(double height) {
  Scene scene;
  scene.ground = false;
  scene.lamp.on = false;
  scene.light.type = LightType::directional;
  scene.light.intensity = 100;
  scene.light.rpy_deg = {0, 60, 0};
  scene.meshes.push_back(share(make_box({3.5, 1, 0.2}, "plaster")));
  scene.instances.push_back({0, 1, {{}, {0.8, 0, -0.1}}, 1});
  if (height <= 0) return scene;
  scene.meshes.push_back(share(make_box({0.8, 2, kSlab}, "plaster")));
  scene.instances.push_back({1, 1, {{}, {-0.4, 0, height - kSlab / 2}}, 2});
  return scene;
}

// Of the disc's area, what is on one side of a line that far from its middle; unit: radius.
double share_of_disc(double t) {
  t = std::clamp(t, -1.0, 1.0);
  return 0.5 + (t * std::sqrt(1 - t * t) + std::asin(t)) / portable::kPi;
}

double expected_share(double x, double height) {
  return share_of_disc((kElevation - std::atan2(height, x)) / double(kSunRadius));
}

RenderOptions options(int threads = 1) {
  RenderOptions out = cached_options();
  out.bake = false, out.antialias = false, out.threads = threads;
  out.texture_size = 16;
  return out;
}

const Intrinsics kLens = pinhole(160, 24, 640);

// Over the shadow's edge, below the slab's height; pixels of half a millimetre.
Pose camera(double height) {
  const double x = height / std::tan(kElevation);
  return look_at({x + 0.01, -0.05, 0.32}, {x + 0.01, 0, 0});
}

struct Pixel {
  double x, share;  // where; of the sun's light
};

// Row after row. The light of the sky is what is left in the umbra.
std::vector<Pixel> draw(double height, RenderQuality quality = RenderQuality::fast) {
  SoftwareDevice device;
  RenderOptions chosen = options();
  chosen.colour.quality = quality;
  const ViewRays view{0, kLens, camera(height)};
  Renderer open(device, edge_scene(0), chosen), covered(device, edge_scene(height), chosen);
  const std::vector<float> lit = open.render_linear(view).rgb, drawn = covered.render_linear(view).rgb;
  const Frame frame = covered.view(view).into_frame(0, {find_image_stream("position")});
  const std::vector<float>& places = frame.get<float>("position");
  double umbra = 1;
  for (std::size_t i = 1; i < lit.size(); i += 3) umbra = std::min(umbra, double(drawn[i] / lit[i]));
  std::vector<Pixel> out;
  for (std::size_t i = 0; i < lit.size(); i += 3)
    out.push_back({double(places[i]), (double(drawn[i + 1] / lit[i + 1]) - umbra) / (1 - umbra)});
  return out;
}

class Penumbra : public ::testing::TestWithParam<double> {};

TEST_P(Penumbra, IsThatOfADiscCutByALine) {
  const std::vector<Pixel> pixels = draw(GetParam());
  double sum = 0, most = 0, bias = 0;
  int dark = 0, partly = 0, lit = 0;
  for (const Pixel& p : pixels) {
    const double expected = expected_share(p.x, GetParam()), off = p.share - expected;
    dark += expected <= 0, lit += expected >= 1;
    if (expected <= 0 || expected >= 1) {
      EXPECT_NEAR(off, 0, 0.13) << p.x;
      continue;
    }
    ++partly;
    sum += std::fabs(off), bias += off, most = std::max(most, std::fabs(off));
  }
  RecordProperty("mean_error", std::to_string(sum / partly));
  EXPECT_GT(std::min(dark, std::min(partly, lit)), 200);
  EXPECT_LT(sum / partly, 0.05);
  EXPECT_LT(std::fabs(bias / partly), 0.045);
  EXPECT_LT(most, 0.13);
}

TEST_P(Penumbra, HasNoSteps) {
  const std::vector<Pixel> pixels = draw(GetParam());
  for (std::size_t i = 1; i < pixels.size(); ++i) {
    if (i % std::size_t(kLens.width) == 0) continue;
    const double expected = expected_share(pixels[i].x, GetParam()) - expected_share(pixels[i - 1].x, GetParam());
    EXPECT_LT(std::fabs(pixels[i].share - pixels[i - 1].share), std::fabs(expected) + 0.07) << i;
  }
}

// Half a penumbra away from the edge all is light or shadow in a draft.
TEST_P(Penumbra, IsNotInDrafts) {
  const auto count_partly_lit = [](const std::vector<Pixel>& pixels) {
    return std::count_if(pixels.begin(), pixels.end(), [](const Pixel& p) { return p.share > 0.15 && p.share < 0.85; });
  };
  EXPECT_LT(3 * count_partly_lit(draw(GetParam(), RenderQuality::draft)), count_partly_lit(draw(GetParam())));
}

INSTANTIATE_TEST_SUITE_P(Heights, Penumbra, ::testing::Values(0.5, 2.0));

TEST(SunShadow, HasTheSameBitsForAnyNumberOfThreads) {
  SoftwareDevice device;
  const auto draw_with = [&](int threads) {
    return Renderer(device, make_heap(60, 3), options(threads))
        .render_linear(look_at({3, 2, 1.5}, {0, 0, 0.4}), pinhole(160, 120, 150))
        .rgb;
  };
  EXPECT_TRUE(draw_with(1) == draw_with(2));
}

// Pixels whose share of the sun is another: a texel of the map lies on an edge within its rounding.
TEST(SunShadow, IsThatOfTheShadersOfGl) {
  GlDevice gl;
  SoftwareDevice software;
  const Scene scene = make_heap(60, 3);
  const auto draw_by = [&](Device& device) {
    RenderOptions chosen = options();
    chosen.shadow_size = 1024;
    return Renderer(device, scene, chosen).render_linear(look_at({3, 2, 1.5}, {0, 0, 0.4}), pinhole(160, 120, 150)).rgb;
  };
  const std::vector<float> a = draw_by(gl), b = draw_by(software);
  ASSERT_EQ(a.size(), b.size());
  double sum = 0, off = 0;
  std::size_t far = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += double(a[i]), off += std::fabs(double(a[i] - b[i]));
    far += std::fabs(a[i] - b[i]) > 0.1f * std::max(a[i], b[i]);
  }
  EXPECT_LT(off / sum, 0.004);
  EXPECT_LT(double(far) / double(a.size()), 0.004);
}

// Of the pixels that the slab does not light anew, the light is the same whether it rests or has moved to its place.
TEST(SunShadow, OfWhatMovesIsThatOfWhatRests) {
  SoftwareDevice device;
  const ViewRays view{1000000000, kLens, camera(0.5)};
  Scene scene = edge_scene(0.5);
  const Pose place = scene.instances[1].world_from_body;
  const std::vector<float> rests = Renderer(device, scene, options()).render_linear(view).rgb;
  scene.motion.moving = {1};
  scene.motion.reach = {{-3, -2, 0}, {1, 2, 1}};
  scene.motion.poses_at = [place](std::int64_t stamp_ns) {
    Pose pose = place;
    pose.translation.x -= 1 - double(stamp_ns) * 1e-9;
    return std::vector<std::optional<Pose>>{pose};
  };
  Renderer renderer(device, scene, options());
  renderer.render_linear({0, kLens, camera(0.5)});  // where it was before
  const std::vector<float> moved = renderer.render_linear(view).rgb;
  const auto range = [](const std::vector<float>& rgb, std::size_t at) {
    const std::size_t row = 12 * std::size_t(kLens.width) * 3 + 1, last = row + 3 * std::size_t(kLens.width - 1);
    return (rgb[row + 3 * at] - rgb[row]) / (rgb[last] - rgb[row]);
  };
  int partly = 0;
  for (std::size_t u = 0; u < std::size_t(kLens.width); ++u) {
    EXPECT_NEAR(range(moved, u), range(rests, u), 0.12) << u;
    partly += range(rests, u) > 0.1f && range(rests, u) < 0.9f;
  }
  EXPECT_GT(partly, 5);
}

TEST(SunShadow, RectanglesAreMergedWithoutLosingAny) {
  const std::vector<TexelRect> merged =
      merge_rects({{0, 0, 4, 4}, {20, 20, 24, 24}, {2, 0, 6, 4}, {21, 21, 22, 22}});
  ASSERT_EQ(merged.size(), 2u);
  EXPECT_EQ(merged[0].x0, 0);
  EXPECT_EQ(merged[0].x1, 6);
  EXPECT_EQ(merged[1].x0, 20);
  EXPECT_EQ(merged[1].x1, 24);
}

// Edges that a block meets are found at every level, and nothing else.
TEST(SunShadow, BlocksAreFoundWhereEdgesAre) {
  std::vector<std::uint32_t> words(2 * 64 * 64, 0xffffu);
  words[2 * (40 * 64 + 8)] = 1000u | 60000u << 16;
  const EdgePyramid pyramid(words.data(), 64);
  const auto nearest = [&](float x0, float y0, float x1, float y1) { return pyramid.range(x0, y0, x1, y1).nearest; };
  const float x = 8.5f / 64, y = 40.5f / 64;
  for (const float wide : {0.001f, 0.02f, 0.1f, 0.5f}) EXPECT_EQ(nearest(x - wide, y - wide, x + wide, y + wide), 1000);
  EXPECT_EQ(nearest(x + 0.1f, y, x + 0.12f, y + 0.02f), 65535);
  EXPECT_EQ(pyramid.range(x, y, x, y).most, 60000);
}

}  // namespace sun_shadow_test
}  // namespace rubble::testing
