// Files of pictures: PNG of colour and of 16-bit depth, and JPEG.
#pragma once

#include <cmath>
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

// The bytes of a JPEG file of 3 bytes a pixel, rows from the top. quality: 1 to 100. Throws
// RunError.
std::string encode_jpeg(int width, int height, const std::uint8_t* rgb, int quality = 90);

// Depth as 16-bit integers, the way ROS (16UC1), MRPT and TUM store it.
// Rounds metres to multiples of `unit` (m). 0 means no return: for NaN, infinity, and for what is
// too far to be held (at 1 mm: beyond 65.535 m). A return nearer than half a unit becomes 1.
inline std::vector<std::uint16_t> encode_depth(const std::vector<float>& depth, double unit) {
  std::vector<std::uint16_t> encoded(depth.size(), 0);
  const double per_metre = 1.0 / unit;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const double units = static_cast<double>(depth[i]) * per_metre + 0.5;
    // Written so that NaN fails it.
    if (depth[i] > 0 && units < 65536.0) {
      const auto whole = static_cast<std::uint16_t>(units);
      encoded[i] = whole > 0 ? whole : std::uint16_t{1};
    }
  }
  return encoded;
}

}  // namespace rubble
