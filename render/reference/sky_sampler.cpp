#include "render/reference/sky_sampler.h"

#include <algorithm>
#include <cmath>

namespace rubble {

namespace {

constexpr int kSide = Sky::kSide;

float luminance_of(const Vec3f& c) { return dot(c, Vec3f(0.2126f, 0.7152f, 0.0722f)); }

// |x| + |y| + z of a direction: the inverse of the distance at which it meets the octahedron, whose
// upper half the map is. A map area of 1 at that place is seen at the solid angle 2 flat^3.
float flat_of(const Vec3f& d) { return std::fabs(d.x) + std::fabs(d.y) + std::max(d.z, 0.0f); }

Vec3f direction_of(float u, float v) {
  const float s = 2 * u - 1, t = 2 * v - 1, x = (s + t) * 0.5f, y = (s - t) * 0.5f;
  return normalized(Vec3f(x, y, std::max(0.0f, 1 - std::fabs(x) - std::fabs(y))));
}

// Turns values into their running sum from 0 to 1.
void accumulate(float* first, int count) {
  double sum = 0;
  for (int i = 1; i <= count; ++i) sum += double(first[i]);
  double running = 0;
  for (int i = 1; i <= count; ++i) {
    running += double(first[i]);
    first[i] = sum > 0 ? float(running / sum) : float(i) / float(count);
  }
  first[0] = 0, first[count] = 1;
}

// The interval that u falls into, and where in it.
int find_interval(const float* sums, int count, float u, float& within) {
  const int i = std::clamp(int(std::upper_bound(sums, sums + count, u) - sums) - 1, 0, count - 1);
  const float width = sums[i + 1] - sums[i];
  within = width > 0 ? std::clamp((u - sums[i]) / width, 0.0f, 0.999999f) : 0.5f;
  return i;
}

}  // namespace

SkySampler::SkySampler(const Sky& sky)
    : rows_(kSide + 1), columns_(std::size_t(kSide) * (kSide + 1)) {
  float mean = 0;
  for (const Vec3f& value : sky.map) mean += luminance_of(value) / float(sky.map.size());
  if (mean <= 0) return;
  for (int y = 0; y < kSide; ++y) {
    float* row = &columns_[std::size_t(y) * (kSide + 1)];
    for (int x = 0; x < kSide; ++x) {
      const Vec3f d = direction_of((float(x) + 0.5f) / kSide, (float(y) + 0.5f) / kSide);
      const float flat = flat_of(d);
      // A little of the mean everywhere: values between texels must not be missed.
      const float bright = luminance_of(sky.map[std::size_t(y * kSide + x)]) + 0.05f * mean;
      row[x + 1] = bright * flat * flat * flat;
      rows_[std::size_t(y) + 1] += row[x + 1];
    }
    accumulate(row, kSide);
  }
  accumulate(rows_.data(), kSide);
}

SkySampler::Sample SkySampler::draw(SamplePair u) const {
  if (rows_.back() <= 0) return {};
  float in_row = 0, in_column = 0;
  const int y = find_interval(rows_.data(), kSide, u.y, in_row);
  const int x =
      find_interval(&columns_[std::size_t(y) * (kSide + 1)], kSide, u.x, in_column);
  Sample sample;
  sample.direction =
      direction_of((float(x) + in_column) / kSide, (float(y) + in_row) / kSide);
  sample.density = density(sample.direction);
  return sample;
}

float SkySampler::density(const Vec3f& d) const {
  if (rows_.back() <= 0 || d.z < 0) return 0;
  const float flat = flat_of(d), px = d.x / flat, py = d.y / flat;
  const int x = std::clamp(int((px + py) * 0.5f * kSide + 0.5f * kSide), 0, kSide - 1);
  const int y = std::clamp(int((px - py) * 0.5f * kSide + 0.5f * kSide), 0, kSide - 1);
  const float* row = &columns_[std::size_t(y) * (kSide + 1)];
  const float share = (rows_[std::size_t(y) + 1] - rows_[std::size_t(y)]) * (row[x + 1] - row[x]);
  // dOmega = 2 flat^3 du dv: a square of the map's area is 1 in u, v.
  return share * kSide * kSide / (2 * flat * flat * flat);
}

}  // namespace rubble
