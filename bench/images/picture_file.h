// Pictures of any kind from disk, and the keypoints in them, by OpenCV.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace rubble {

struct Picture {
  int width = 0, height = 0;      // unit: pixel
  std::vector<std::uint8_t> rgb;  // 3 bytes a pixel, rows from the top
};
// PNG, JPEG or whatever else OpenCV reads. Throws InputError.
Picture read_picture(const std::string& path);

// SIFT keypoints (Lowe 2004) with OpenCV's defaults, without a limit on their number.
int count_keypoints(const Picture& picture);

}  // namespace rubble
