// A mosaic of colour filters over the photosites, and the colours that are worked out from it.
#pragma once

#include <cstdint>
#include <vector>

#include "render/scene/camera_spec.h"

namespace rubble {

// Which colour (0 red, 1 green, 2 blue) the photosite of a column and row has; not of Mosaic::none.
int mosaic_colour(Mosaic mosaic, int x, int y);

// Three counts a pixel from one: gradient-corrected bilinear interpolation (Malvar, He and Cutler 2004,
// "High-Quality Linear Interpolation for Demosaicing of Bayer-Patterned Color Images", figure 2). Beyond
// the border the mosaic goes on as in a mirror on its outermost photosites. most: the highest count.
std::vector<std::uint16_t> demosaic(Mosaic mosaic, int width, int height,
                                    const std::vector<std::uint16_t>& counts, int most);

}  // namespace rubble
