// The pixels of a PNG file as they are stored: no gamma, no conversion to another number of bits.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace rubble {

struct PngPixels {
  int width = 0, height = 0;         // unit: pixel
  int channels = 0;                  // 1: grey, 2: grey and alpha, 3: RGB, 4: RGBA; palettes are looked up
  int bits = 8;                      // a channel, 8 or 16; fewer are scaled up to 8
  std::vector<std::uint16_t> values; // rows from the top, no padding; range: 0 to 2^bits - 1
};

// Throws RunError: "is a damaged PNG: ...", or more than kLargestPicture pixels a side.
PngPixels read_png_pixels(std::string_view bytes);

}  // namespace rubble
