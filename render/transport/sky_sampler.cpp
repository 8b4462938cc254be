#include "render/transport/sky_sampler.h"

#include <algorithm>
#include <cmath>

namespace rubble {

namespace {

float luminance_of(const Vec3f& c) { return dot(c, Vec3f(0.2126f, 0.7152f, 0.0722f)); }

// |x| + |y| + z of a direction: the inverse of the distance at which it meets the octahedron, whose
// upper half the map is. A map area of 1 at that place is seen at the solid angle 2 flat^3.
float flat_of(const Vec3f& d) { return std::fabs(d.x) + std::fabs(d.y) + std::max(d.z, 0.0f); }

Vec3f direction_of(float u, float v) {
  const float s = 2 * u - 1, t = 2 * v - 1, x = (s + t) * 0.5f, y = (s - t) * 0.5f;
  return normalized(Vec3f(x, y, std::max(0.0f, 1 - std::fabs(x) - std::fabs(y))));
}

}  // namespace

void SkySampler::Line::accumulate(const std::vector<float>& weights) {
  const std::size_t side = weights.size();
  sums.assign(side + 1, 0), start.assign(side, 0);
  double sum = 0, running = 0;
  for (const float w : weights) sum += double(w);
  for (std::size_t i = 0; i < side; ++i) {
    running += double(weights[i]);
    sums[i + 1] = float(running / sum);
  }
  sums[side] = 1;
  std::size_t at = 0;
  for (std::size_t part = 0; part < side; ++part) {
    while (at + 1 < side && sums[at + 1] <= float(part) / float(side)) ++at;
    start[part] = std::uint16_t(at);
  }
}

// The interval that u falls into, and where in it.
int SkySampler::Line::find(float u, float& within) const {
  const std::size_t side = start.size();
  std::size_t i = start[std::min(std::size_t(u * float(side)), side - 1)];
  while (i + 1 < side && sums[i + 1] <= u) ++i;
  const float width = sums[i + 1] - sums[i];
  within = width > 0 ? std::clamp((u - sums[i]) / width, 0.0f, 0.999999f) : 0.5f;
  return int(i);
}

SkySampler::SkySampler(const Sky& sky) : side_(sky.side), columns_(std::size_t(sky.side)) {
  float mean = 0;
  for (const Vec3f& value : sky.map) mean += luminance_of(value) / float(sky.map.size());
  if (mean <= 0) return;
  black_ = false;
  const std::size_t side = columns_.size();
  std::vector<float> of_rows(side), weights(side);
  for (std::size_t y = 0; y < side; ++y) {
    for (std::size_t x = 0; x < side; ++x) {
      const Vec3f d = direction_of((float(x) + 0.5f) / float(side), (float(y) + 0.5f) / float(side));
      const float flat = flat_of(d);
      // A little of the mean everywhere: values between texels must not be missed.
      const float bright = luminance_of(sky.map[y * side + x]) + 0.05f * mean;
      weights[x] = bright * flat * flat * flat;
      of_rows[y] += weights[x];
    }
    columns_[y].accumulate(weights);
  }
  rows_.accumulate(of_rows);
}

SkySampler::Sample SkySampler::draw(SamplePair u) const {
  if (black_) return {};
  float in_row = 0, in_column = 0;
  const int y = rows_.find(u.y, in_row), x = columns_[std::size_t(y)].find(u.x, in_column);
  Sample sample;
  sample.direction =
      direction_of((float(x) + in_column) / float(side_), (float(y) + in_row) / float(side_));
  sample.density = density(sample.direction);
  return sample;
}

float SkySampler::density(const Vec3f& d) const {
  if (black_ || d.z < 0) return 0;
  const float flat = flat_of(d), px = d.x / flat, py = d.y / flat;
  const float side = float(side_);
  const int x = std::clamp(int((px + py) * 0.5f * side + 0.5f * side), 0, side_ - 1);
  const int y = std::clamp(int((px - py) * 0.5f * side + 0.5f * side), 0, side_ - 1);
  const float share = rows_.share(y) * columns_[std::size_t(y)].share(x);
  // dOmega = 2 flat^3 du dv: a square of the map's area is 1 in u, v.
  return share * side * side / (2 * flat * flat * flat);
}

}  // namespace rubble
