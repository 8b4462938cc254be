// Textures of one size with their halved levels: read on the processor, and handed to the graphics device.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/materials/textures.h"

namespace rubble {

// IEC 61966-2-1, for 0 to 1.
float linear_from_srgb_code(float code);
float decode_srgb(std::uint8_t code);
std::uint8_t encode_srgb(float linear);

class TextureStack {
 public:
  TextureStack() = default;  // of none
  explicit TextureStack(const std::vector<PatternImage>& patterns);
  // encoded: by image, whether it is sRGB, and is averaged as the light that it stands for.
  TextureStack(const std::vector<PatternImage>& patterns, const std::vector<bool>& encoded);

  // The four channels from 0 to 1, between texels; u and v repeat every 1. level: 0 is the finest,
  // rounded to the nearest.
  std::array<float, 4> read(int pattern, float u, float v, float level) const;
  int size() const { return size_; }  // of the finest level; unit: texel
  int levels() const { return levels_; }
  // 4 bytes a texel, rows.
  const std::vector<std::uint8_t>& texels(int pattern, int level) const {
    return texels_[std::size_t(pattern * levels_ + level)];
  }

 private:
  int size_ = 1, levels_ = 1;
  std::vector<std::vector<std::uint8_t>> texels_;  // by pattern and level
};

}  // namespace rubble
