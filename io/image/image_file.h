// PNG files of colour and of 16-bit depth.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace rubble {

// Rows from the top, no padding.
struct RgbImage {
  int width = 0, height = 0;      // unit: pixel
  std::vector<std::uint8_t> rgb;  // 3 bytes a pixel
};
struct GrayImage {
  int width = 0, height = 0;         // unit: pixel
  std::vector<std::uint8_t> values;  // one a pixel
};
struct DepthImage {
  int width = 0, height = 0;          // unit: pixel
  std::vector<std::uint16_t> values;  // in the unit of whoever encoded them; 0: no return
};

// Luma of ITU-R BT.601, in integers.
GrayImage to_gray(const RgbImage& image);

// The bytes of a PNG file. level: 0 (stored) to 9 (smallest); lossless. Throws RunError.
std::string encode_png(const RgbImage& image, int level = 1);
std::string encode_png(const GrayImage& image, int level = 1);
std::string encode_png(const DepthImage& image, int level = 1);

// Throw RunError when the file cannot be written.
void write_png(const std::string& path, const RgbImage& image, int level = 1);
void write_png(const std::string& path, const DepthImage& image, int level = 1);

// Throw InputError for a file that is missing, no PNG, or of another kind of pixels.
RgbImage read_rgb_png(const std::string& path);
DepthImage read_depth_png(const std::string& path);

}  // namespace rubble
