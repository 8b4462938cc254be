// Procedural textures: made by code, the same from run to run on one machine.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/base/system/disk_cache.h"
#include "render/materials/surface_appearance.h"

namespace rubble {

// One tileable square, 4 bytes a texel: slope of the relief along x and along y (128: none),
// brightness between a look's dark and light, and the mask of its accent.
struct PatternImage {
  int size = 0;                      // of a side; a power of two; unit: texel
  std::vector<std::uint8_t> texels;  // rows, size * size * 4 bytes
};

// size: a power of two.
PatternImage make_pattern(Pattern pattern, int size);

// One image a pattern, in the order of Pattern, made by `threads` threads.
std::vector<PatternImage> make_patterns(int size, int threads);
// The same by way of the disk cache.
std::vector<PatternImage> make_patterns_once(const DiskCache& cache, int size, int threads);

}  // namespace rubble
