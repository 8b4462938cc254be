// The procedural textures with their halved levels, read on the processor.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/materials/textures.h"

namespace rubble {

class TextureStack {
 public:
  explicit TextureStack(const std::vector<PatternImage>& patterns);

  // The four channels from 0 to 1, between texels; u and v repeat every 1. level: 0 is the finest,
  // rounded to the nearest.
  std::array<float, 4> read(int pattern, float u, float v, float level) const;
  int size() const { return size_; }  // of the finest level; unit: texel

 private:
  int size_ = 1, levels_ = 1;
  std::vector<std::vector<std::uint8_t>> texels_;  // by pattern and level
};

}  // namespace rubble
