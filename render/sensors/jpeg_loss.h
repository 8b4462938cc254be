// What a picture loses as a baseline JPEG (ITU-T T.81, JFIF 1.02): the tables of its annex K at a quality
// of 1 to 100 as the Independent JPEG Group scales them, colour at half the resolution in both
// directions. The lossless part, the coding of the coefficients, is left out.
#pragma once

#include <cstdint>
#include <vector>

namespace rubble {

// Three bytes a pixel, rows from the top.
void lose_to_jpeg(std::vector<std::uint8_t>& rgb, int width, int height, int quality, int threads);

}  // namespace rubble
