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

}  // namespace rubble
