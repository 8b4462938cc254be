#include "render/sky/clouds.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "kernel/base/portable_math.h"
#include "kernel/base/random.h"
#include "render/materials/tile_noise.h"

namespace rubble {

namespace {

constexpr float kHeight = 1200, kEarth = 6360e3f;  // unit: m
constexpr float kTile = 48e3f;                      // after which the layer repeats; unit: m
constexpr int kCells = 24, kOctaves = 7;            // the largest clouds: 2 km
constexpr float kRise = 0.16f;                      // of the noise, from the rim to full thickness
constexpr float kThickest = 32;
constexpr float kForward = 0.85f;                   // asymmetry of droplets
constexpr float kFade = 16e3f;                      // clouds fade by e over this; unit: m
constexpr float kTowards = 260;  // how far towards the sun a neighbour shades; unit: m

float diffuse_share(float tau) { return 1 / (1 + (1 - kForward) * tau * 0.866f); }

}  // namespace

CloudLayer::CloudLayer(double cover, std::uint64_t seed, const Vec3f& to_sun, const Vec3f& beam,
                       const Vec3f& sky_light)
    : none_(cover <= 0),
      seed_(std::uint32_t(RandomStream(seed, "sky/clouds").next())),
      to_sun_(to_sun),
      beam_(beam),
      level_(sky_light + beam * std::max(to_sun.z, 0.0f)) {
  // The threshold that the stated share of the layer exceeds.
  constexpr int kSide = 128;
  std::vector<float> values;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x)
      values.push_back(noise(float(x) * (kTile / kSide), float(y) * (kTile / kSide)));
  std::sort(values.begin(), values.end());
  const double below = std::clamp(1 - cover, 0.0, 1.0) * double(values.size() - 1);
  threshold_ = cover >= 1 ? values.front() - kRise : values[std::size_t(below)];
}

CloudLayer::Place CloudLayer::meet(const Vec3f& d) const {
  const float z = std::max(d.z, 0.0f), rise = z * kEarth;
  const float far = std::sqrt(rise * rise + 2 * kEarth * kHeight + kHeight * kHeight) - rise;
  return {d.x * far, d.y * far, far};
}

// Broad billows with round heads.
float CloudLayer::noise(float x, float y) const {
  const float u = x / kTile, v = y / kTile;
  const float broad = tile_fractal(u, v, kCells, kOctaves, 0.57f, seed_);
  const float heads = 1 - std::min(1.0f, tile_cells(u, v, 3 * kCells, seed_ + 77).nearest);
  return 0.8f * broad + 0.2f * heads;
}

float CloudLayer::thickness_at(float x, float y) const {
  const float t = std::clamp((noise(x, y) - threshold_) / kRise, 0.0f, 1.0f);
  return kThickest * t * t;
}

float CloudLayer::thickness(const Vec3f& d) const {
  if (none_) return 0;
  const Place at = meet(d);
  return thickness_at(at.x, at.y);
}

float CloudLayer::beam_share(const Vec3f& d) const {
  return d.z > 0 ? float(portable::exp(-double(thickness(d)))) : 1.0f;
}

Vec3f CloudLayer::cover(const Vec3f& d, const Vec3f& clear, const Vec3f& horizon) const {
  if (none_) return clear;
  const Place at = meet(d);
  const float tau = thickness_at(at.x, at.y);
  if (tau <= 0) return clear;
  const float passed = float(portable::exp(-double(tau)));
  // The sun lights a cloud from its side: what stands before it there takes some of the light.
  const float beside = thickness_at(at.x + kTowards * to_sun_.x, at.y + kTowards * to_sun_.y);
  const float g = kForward, c = dot(d, to_sun_), base = 1 + g * g - 2 * g * c;
  const float phase = (1 - g * g) / (4 * portable::kPiF * base * std::sqrt(base));
  const Vec3f many = level_ * ((1 - passed) * diffuse_share(0.5f * (tau + beside)) / portable::kPiF);
  const Vec3f once = beam_ * (phase * tau * passed);
  const Vec3f seen = clear * passed + many + once;
  const float faded = 1 - float(portable::exp(-double(std::max(0.0f, at.far - 2 * kHeight) / kFade)));
  return seen + (clear * (1 - 0.5f * (1 - passed)) + horizon * (0.5f * (1 - passed)) - seen) * faded;
}

}  // namespace rubble
