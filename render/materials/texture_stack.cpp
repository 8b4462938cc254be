#include "render/materials/texture_stack.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "kernel/base/quick_math.h"

namespace rubble {

namespace {

std::vector<std::uint8_t> halve(const std::vector<std::uint8_t>& texels, int size) {
  const std::size_t row = std::size_t(size) * 4, half = std::size_t(size / 2);
  std::vector<std::uint8_t> out(half * half * 4);
  for (std::size_t y = 0; y < half; ++y) {
    for (std::size_t x = 0; x < half; ++x) {
      for (std::size_t c = 0; c < 4; ++c) {
        const std::size_t at = 2 * y * row + 8 * x + c;
        const int sum = texels[at] + texels[at + 4] + texels[at + row] + texels[at + row + 4];
        out[(y * half + x) * 4 + c] = std::uint8_t((sum + 2) / 4);
      }
    }
  }
  return out;
}

// Of three colours that are encoded as sRGB; the fourth channel is averaged as it is.
std::vector<std::uint8_t> halve_encoded(const std::vector<std::uint8_t>& texels, int size) {
  const std::size_t row = std::size_t(size) * 4, half = std::size_t(size / 2);
  std::vector<std::uint8_t> out = halve(texels, size);
  for (std::size_t y = 0; y < half; ++y) {
    for (std::size_t x = 0; x < half; ++x) {
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t at = 2 * y * row + 8 * x + c;
        const float sum = decode_srgb(texels[at]) + decode_srgb(texels[at + 4]) +
                          decode_srgb(texels[at + row]) + decode_srgb(texels[at + row + 4]);
        out[(y * half + x) * 4 + c] = encode_srgb(sum / 4);
      }
    }
  }
  return out;
}

}  // namespace

float linear_from_srgb_code(float code) {
  return code <= 0.04045f ? code / 12.92f : quick::pow((code + 0.055f) / 1.055f, 2.4f);
}

float decode_srgb(std::uint8_t code) {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> out;
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = linear_from_srgb_code(float(i) / 255);
    return out;
  }();
  return table[code];
}

std::uint8_t encode_srgb(float linear) {
  const float x = std::clamp(linear, 0.0f, 1.0f);
  const float code = x <= 0.0031308f ? 12.92f * x : 1.055f * quick::pow(x, 1 / 2.4f) - 0.055f;
  return std::uint8_t(code * 255 + 0.5f);
}

TextureStack::TextureStack(const std::vector<PatternImage>& patterns)
    : TextureStack(patterns, std::vector<bool>(patterns.size(), false)) {}

TextureStack::TextureStack(const std::vector<PatternImage>& patterns, const std::vector<bool>& encoded)
    : size_(patterns.front().size), levels_(int(std::lround(quick::log2(double(size_)))) + 1) {
  for (std::size_t i = 0; i < patterns.size(); ++i) {
    texels_.push_back(patterns[i].texels);
    for (int size = size_; size > 1; size /= 2)
      texels_.push_back(encoded[i] ? halve_encoded(texels_.back(), size) : halve(texels_.back(), size));
  }
}

std::array<float, 4> TextureStack::read(int pattern, float u, float v, float level) const {
  const int l = std::clamp(int(level + 0.5f), 0, levels_ - 1), size = size_ >> l, mask = size - 1;
  const std::uint8_t* texels = texels_[std::size_t(pattern * levels_ + l)].data();
  const float x = (u - std::floor(u)) * float(size) - 0.5f;
  const float y = (v - std::floor(v)) * float(size) - 0.5f;
  const float fx = std::floor(x), fy = std::floor(y), a = x - fx, b = y - fy;
  const int x0 = int(fx) & mask, x1 = (x0 + 1) & mask;
  const std::uint8_t* upper = texels + std::ptrdiff_t(int(fy) & mask) * size * 4;
  const std::uint8_t* lower = texels + std::ptrdiff_t((int(fy) + 1) & mask) * size * 4;
  std::array<float, 4> out;
  for (std::size_t c = 0; c < 4; ++c) {
    const float top = float(upper[std::size_t(x0) * 4 + c]) * (1 - a) +
                      float(upper[std::size_t(x1) * 4 + c]) * a;
    const float bottom = float(lower[std::size_t(x0) * 4 + c]) * (1 - a) +
                         float(lower[std::size_t(x1) * 4 + c]) * a;
    out[c] = (top * (1 - b) + bottom * b) * (1.0f / 255);
  }
  return out;
}

}  // namespace rubble
