#include "render/reference/display.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "kernel/base/quick_math.h"
#include "render/surface/scalar_surface.h"

namespace rubble {

namespace {

constexpr int kMeterEvery = 4;  // as METER in shaders/resolve.frag.glsl

}  // namespace

MeteredImage meter_image(const std::vector<float>& light, int width, int height,
                         const Vec3f& gains) {
  const auto count = [](int pixels) { return (pixels + kMeterEvery / 2 - 1) / kMeterEvery; };
  MeteredImage out;
  out.width = count(width), out.height = count(height);
  for (int y = 0; y < out.height; ++y) {
    for (int x = 0; x < out.width; ++x) {
      const int u = x * kMeterEvery + kMeterEvery / 2, v = y * kMeterEvery + kMeterEvery / 2;
      const float* p = &light[(std::size_t(v) * std::size_t(width) + std::size_t(u)) * 3];
      const float grey = 0.2126f * p[0] * gains.x + 0.7152f * p[1] * gains.y + 0.0722f * p[2] * gains.z;
      // Exactly black: beyond the edge of a lens.
      out.stops.push_back(grey > 0 ? quick::log2(std::max(grey, 1e-30f)) : -2000);
    }
  }
  return out;
}

std::vector<std::uint8_t> develop_image(const std::vector<float>& light, int width, int height,
                                        const Vec3f& gains, float exposure) {
  std::vector<std::uint8_t> out(std::size_t(width) * std::size_t(height) * 4, 255);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t i = std::size_t(y) * std::size_t(width) + std::size_t(x);
      const float noise = scalar::grain(float(x), float(y));
      for (int c = 0; c < 3; ++c) {
        const float value = light[i * 3 + std::size_t(c)] * exposure * gains[c];
        out[i * 4 + std::size_t(c)] = std::uint8_t(scalar::clamp(scalar::develop(value, noise), 0.0f, 1.0f) * 255 + 0.5f);
      }
    }
  }
  return out;
}

}  // namespace rubble
