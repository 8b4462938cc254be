#include "render/sensors/jpeg_loss.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kernel/base/parallel.h"
#include "kernel/base/portable_math.h"

namespace rubble {

namespace {

constexpr int kBlock = 8;
using Block = std::array<float, kBlock * kBlock>;
using Table = std::array<int, kBlock * kBlock>;

// ITU-T T.81, tables K.1 and K.2, row by row.
constexpr Table kLuminance = {
    16, 11, 10, 16, 24,  40,  51,  61,  12, 12, 14, 19, 26,  58,  60,  55,
    14, 13, 16, 24, 40,  57,  69,  56,  14, 17, 22, 29, 51,  87,  80,  62,
    18, 22, 37, 56, 68,  109, 103, 77,  24, 35, 55, 64, 81,  104, 113, 92,
    49, 64, 78, 87, 103, 121, 120, 101, 72, 92, 95, 98, 112, 100, 103, 99};
constexpr Table kChrominance = {
    17, 18, 24, 47, 99, 99, 99, 99, 18, 21, 26, 66, 99, 99, 99, 99,
    24, 26, 56, 99, 99, 99, 99, 99, 47, 66, 99, 99, 99, 99, 99, 99,
    99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99,
    99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99};

Table scale_table(const Table& table, int quality) {
  const int percent = quality < 50 ? 5000 / quality : 200 - 2 * quality;
  Table out{};
  for (std::size_t i = 0; i < table.size(); ++i)
    out[i] = std::clamp((table[i] * percent + 50) / 100, 1, 255);
  return out;
}

// One component of the picture, at its own resolution.
struct Plane {
  Plane(int w, int h) : width(w), height(h), values(std::size_t(w) * std::size_t(h)) {}
  float at(int x, int y) const {  // the border goes on evenly
    return values[std::size_t(std::clamp(y, 0, height - 1)) * std::size_t(width) +
                  std::size_t(std::clamp(x, 0, width - 1))];
  }
  float& ref(int x, int y) { return values[std::size_t(y) * std::size_t(width) + std::size_t(x)]; }

  int width, height;
  std::vector<float> values;
};

// basis[u * 8 + x]: the discrete cosine transform, orthonormal.
Block make_basis() {
  Block basis{};
  for (int u = 0; u < kBlock; ++u)
    for (int x = 0; x < kBlock; ++x)
      basis[std::size_t(u * kBlock + x)] = float(
          std::sqrt(u == 0 ? 0.125 : 0.25) * portable::cos((2 * x + 1) * u * portable::kPi / 16));
  return basis;
}

// rows(B) * M, or with `inverse` rows(B^T) * M, then the block turned over: twice, and both ways are done.
Block turn(const Block& m, const Block& basis, bool inverse) {
  Block out{};
  for (std::size_t u = 0; u < kBlock; ++u)
    for (std::size_t x = 0; x < kBlock; ++x) {
      float sum = 0;
      for (std::size_t k = 0; k < kBlock; ++k)
        sum += basis[inverse ? k * kBlock + u : u * kBlock + k] * m[k * kBlock + x];
      out[x * kBlock + u] = sum;
    }
  return out;
}

void quantise(Plane& plane, const Table& table, int threads) {
  static const Block basis = make_basis();
  const Plane before = plane;
  parallel_for(std::size_t((plane.height + kBlock - 1) / kBlock), threads, [&](std::size_t row) {
    const int top = int(row) * kBlock;
    for (int left = 0; left < plane.width; left += kBlock) {
      Block block;
      for (int i = 0; i < kBlock * kBlock; ++i)
        block[std::size_t(i)] = before.at(left + i % kBlock, top + i / kBlock) - 128;
      block = turn(turn(block, basis, false), basis, false);
      for (std::size_t i = 0; i < block.size(); ++i)
        block[i] = std::nearbyint(block[i] / float(table[i])) * float(table[i]);
      block = turn(turn(block, basis, true), basis, true);
      for (int i = 0; i < kBlock * kBlock; ++i)
        if (const int x = left + i % kBlock, y = top + i / kBlock; x < plane.width && y < plane.height)
          plane.ref(x, y) = std::clamp(std::nearbyint(block[std::size_t(i)]) + 128, 0.0f, 255.0f);
    }
  });
}

Plane halve(const Plane& plane) {
  Plane half((plane.width + 1) / 2, (plane.height + 1) / 2);
  for (int y = 0; y < half.height; ++y)
    for (int x = 0; x < half.width; ++x)
      half.ref(x, y) = std::nearbyint(0.25f * (plane.at(2 * x, 2 * y) + plane.at(2 * x + 1, 2 * y) +
                                               plane.at(2 * x, 2 * y + 1) +
                                               plane.at(2 * x + 1, 2 * y + 1)));
  return half;
}

// Between four pixels of half the resolution, 9 3 3 1.
float doubled(const Plane& half, int x, int y) {
  const int u = x / 2, v = y / 2, du = x % 2 ? 1 : -1, dv = y % 2 ? 1 : -1;
  return (9 * half.at(u, v) + 3 * half.at(u + du, v) + 3 * half.at(u, v + dv) + half.at(u + du, v + dv)) /
         16;
}

}  // namespace

void lose_to_jpeg(std::vector<std::uint8_t>& rgb, int width, int height, int quality, int threads) {
  Plane y(width, height), blue(width, height), red(width, height);
  for (std::size_t i = 0; i < y.values.size(); ++i) {
    const float r = rgb[3 * i], g = rgb[3 * i + 1], b = rgb[3 * i + 2];
    y.values[i] = std::nearbyint(0.299f * r + 0.587f * g + 0.114f * b);
    blue.values[i] = std::nearbyint(128 - 0.168736f * r - 0.331264f * g + 0.5f * b);
    red.values[i] = std::nearbyint(128 + 0.5f * r - 0.418688f * g - 0.081312f * b);
  }
  Plane half_blue = halve(blue), half_red = halve(red);
  const Table fine = scale_table(kLuminance, quality), coarse = scale_table(kChrominance, quality);
  quantise(y, fine, threads), quantise(half_blue, coarse, threads), quantise(half_red, coarse, threads);
  const auto byte = [](float v) { return std::uint8_t(std::clamp(std::nearbyint(v), 0.0f, 255.0f)); };
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      const std::size_t i = std::size_t(v) * std::size_t(width) + std::size_t(u);
      const float cb = doubled(half_blue, u, v) - 128, cr = doubled(half_red, u, v) - 128;
      rgb[3 * i] = byte(y.values[i] + 1.402f * cr);
      rgb[3 * i + 1] = byte(y.values[i] - 0.344136f * cb - 0.714136f * cr);
      rgb[3 * i + 2] = byte(y.values[i] + 1.772f * cb);
    }
}

}  // namespace rubble
