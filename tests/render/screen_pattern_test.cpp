// Nothing of the picture may stay on the pixel grid while the camera moves: a tracker would take it for
// landmarks that go along with the camera.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "kernel/base/portable_math.h"
#include "render/devices/software/software_device.h"
#include "render/renderer.h"
#include "tests/render/cached_options.h"
#include "tests/render/test_scene.h"

namespace rubble::testing {
namespace screen_pattern_test {

constexpr int kSide = 192;
constexpr int kFrames = 7;
// Of the camera between frames: over two of them, six pixels, the ground's texture is no longer like itself. Over three
// pixels it still is by 0.03, whatever stays on the grid. unit: m
constexpr double kStep = 0.0311;

// The floor on which cameras of robots look: ground, and a slab on it.
Scene floor_scene() {
  Scene scene;
  scene.lamp.on = false;
  scene.light.type = LightType::sun;
  scene.light.elevation_deg = 40;
  scene.meshes.push_back(share(make_box({1.5, 6, 0.2})));
  scene.instances.push_back({0, 1, {{}, {2.5, 0, 0.1}}, 1});
  return scene;
}

struct Shot {
  std::vector<float> luma, flow;  // flow: to the first shot, two a pixel; unit: pixel
};

std::vector<Shot> fly(Device& device) {
  RenderOptions options = cached_options();
  options.bake = false, options.antialias = false;
  options.texture_size = 256;
  Renderer renderer(device, floor_scene(), options);
  const Intrinsics k = pinhole(kSide, kSide, 0.7 * kSide);
  const auto view = [&](int i) {
    const Vec3 eye(0.02 * i * kStep, i * kStep, 0.6);
    ViewRays rays{0, k, look_at(eye, eye + Vec3(2, 0, -1))};
    rays.noise = std::uint64_t(i);
    return rays;
  };
  const ViewRays first = view(0);
  std::vector<Shot> shots;
  for (int i = 0; i < kFrames; ++i) {
    const Frame frame = renderer.view(view(i), &first).into_frame(i, {find_image_stream("flow")});
    Shot shot;
    for (std::size_t p = 0; p < frame.rgb.size(); p += 3)
      shot.luma.push_back(0.299f * frame.rgb[p] + 0.587f * frame.rgb[p + 1] + 0.114f * frame.rgb[p + 2]);
    shot.flow = flow_of(frame);
    shots.push_back(std::move(shot));
  }
  return shots;
}

// Between pixels; NaN where the point is not on the image.
float at(const std::vector<float>& luma, double u, double v) {
  if (!(u >= 0 && v >= 0 && u < kSide - 1 && v < kSide - 1)) return NAN;
  const int x = int(u), y = int(v);
  const float a = float(u) - float(x), b = float(v) - float(y);
  const float* p = luma.data() + y * kSide + x;
  return (p[0] * (1 - a) + p[1] * a) * (1 - b) + (p[kSide] * (1 - a) + p[kSide + 1] * a) * b;
}

// What the true flow does not explain, without what varies slowly: less the mean of its neighbours.
std::vector<float> residual(const Shot& shot, const Shot& first) {
  std::vector<float> off(shot.luma.size()), out(off.size(), NAN);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const std::size_t i = std::size_t(y * kSide + x);
      off[i] = shot.luma[i] - at(first.luma, x + double(shot.flow[2 * i]), y + double(shot.flow[2 * i + 1]));
    }
  for (int y = 2; y + 2 < kSide; ++y)
    for (int x = 2; x + 2 < kSide; ++x) {
      float sum = 0;
      for (int v = -2; v <= 2; ++v)
        for (int u = -2; u <= 2; ++u) sum += off[std::size_t((y + v) * kSide + x + u)];
      out[std::size_t(y * kSide + x)] = off[std::size_t(y * kSide + x)] - sum / 25;
    }
  return out;
}

// Of two residuals at the same pixels. One half where all of it is a pattern on the pixel grid, for it is
// in each of them and, another part of it, in the first shot.
double correlation(const std::vector<float>& a, const std::vector<float>& b) {
  double ab = 0, aa = 0, bb = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!std::isfinite(a[i]) || !std::isfinite(b[i])) continue;
    ab += double(a[i]) * double(b[i]);
    aa += double(a[i]) * double(a[i]), bb += double(b[i]) * double(b[i]);
  }
  return ab / std::sqrt(aa * bb);
}

double share_on_grid(const std::vector<Shot>& shots) {
  std::vector<std::vector<float>> residuals;
  for (int i = 1; i < kFrames; ++i) residuals.push_back(residual(shots[std::size_t(i)], shots[0]));
  double sum = 0;
  int pairs = 0;
  for (std::size_t i = 0; i < residuals.size(); ++i)
    for (std::size_t k = i + 2; k < residuals.size(); ++k, ++pairs)
      sum += correlation(residuals[i], residuals[k]);
  return sum / pairs;
}

TEST(ScreenPattern, NothingStaysOnThePixelGridWhileTheCameraMoves) {
  SoftwareDevice device;
  EXPECT_LT(share_on_grid(fly(device)), 0.015);
}

// One step of noise glued to the pixels is enough to be found.
TEST(ScreenPattern, AFaintPatternOnThePixelGridIsFound) {
  SoftwareDevice device;
  std::vector<Shot> shots = fly(device);
  const double without = share_on_grid(shots);
  for (Shot& shot : shots)
    for (std::size_t i = 0; i < shot.luma.size(); ++i)
      shot.luma[i] += float(std::uint32_t(i) * 2654435761u >> 28 & 3u) - 1.5f;
  EXPECT_GT(share_on_grid(shots), without + 0.05);
}

}  // namespace screen_pattern_test
}  // namespace rubble::testing
