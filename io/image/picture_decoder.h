// Colour pictures that strangers made, as they lie in the files of meshes: PNG and JPEG of any kind of
// pixels. data_picture.h reads pictures whose pixels are numbers.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace rubble {

// Rows from the top, no padding.
struct RgbaImage {
  int width = 0, height = 0;       // unit: pixel
  std::vector<std::uint8_t> rgba;  // 4 bytes a pixel; grey is three times the same
};

inline constexpr int kLargestPicture = 16384;  // of a side; unit: pixel

// Throws RunError for a picture without pixels, or with more a side.
void check_picture_size(std::uint64_t width, std::uint64_t height);

// Colours as 8 bits of sRGB. 16 bits are rounded to 8: files that have them mean the same curve.
// bytes: of a whole file. Throws RunError that says why it cannot be: "is neither PNG nor JPEG".
RgbaImage decode_picture(std::string_view bytes);

// The pixels of a PNG file as they are stored: no gamma, no conversion to another number of bits.
struct PngPixels {
  int width = 0, height = 0;         // unit: pixel
  int channels = 0;                  // 1: grey, 2: grey and alpha, 3: RGB, 4: RGBA; palettes are looked up
  int bits = 8;                      // a channel, 8 or 16; fewer are scaled up to 8
  std::vector<std::uint16_t> values; // rows from the top, no padding; range: 0 to 2^bits - 1
};

// Throws RunError: "is a damaged PNG: ...", or more than kLargestPicture pixels a side.
PngPixels read_png_pixels(std::string_view bytes);

}  // namespace rubble
