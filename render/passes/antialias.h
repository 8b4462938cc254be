// Smooths the stairs along silhouettes of a finished colour image (after FXAA, Lottes 2009: find
// the ends of a stair, and mix with the pixel across the edge by how far the ends are). Only where
// depth has an edge, so textures stay sharp; depth itself is never touched.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/base/parallel.h"

namespace rubble {

// rgba: 4 bytes a pixel; depth_values: near / Z of the same pixels; rgb: gets 3 bytes a pixel.
void smooth_edges(const std::vector<std::uint8_t>& rgba, const std::vector<float>& depth_values,
                  int width, int height, ThreadPool& pool, std::vector<std::uint8_t>& rgb);
// The same without smoothing.
void copy_colours(const std::vector<std::uint8_t>& rgba, std::vector<std::uint8_t>& rgb);

}  // namespace rubble
