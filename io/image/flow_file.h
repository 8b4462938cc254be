// Optical flow as a Middlebury .flo file (https://vision.middlebury.edu/flow/data/).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/base/atomic_file.h"
#include "io/base/little_endian.h"
#include "kernel/base/error.h"

namespace rubble {

constexpr float kFlowMark = 202021.25f;        // "PIEH": what such a file begins with
constexpr float kUnknownFlow = 1666666752.0f;  // readers take all above 1e9 for unknown

// flow: 2 a pixel, rows from the top; NaN, where there is none, becomes the format's mark for that.
inline std::string encode_flow(int width, int height, const std::vector<float>& flow) {
  std::string bytes;
  bytes.reserve(12 + flow.size() * sizeof(float));
  put(bytes, kFlowMark);
  put(bytes, width);
  put(bytes, height);
  for (const float value : flow) put(bytes, value == value ? value : kUnknownFlow);
  return bytes;
}

struct FlowImage {
  int width = 0, height = 0;  // unit: pixel
  std::vector<float> flow;    // 2 a pixel; what is unknown has the format's mark
};

// Throws InputError for a file that is missing or none of these.
inline FlowImage read_flow(const std::string& path) {
  const std::string bytes = read_whole_file(path);
  std::string_view left = bytes;
  FlowImage image;
  float mark = 0;
  const bool head = take(left, mark) && take(left, image.width) && take(left, image.height);
  const auto width = static_cast<std::uint32_t>(image.width);
  const auto height = static_cast<std::uint32_t>(image.height);
  const std::uint64_t pixels = std::uint64_t(width) * height;  // below 2^64
  if (!head || mark != kFlowMark || left.size() % 8 != 0 || left.size() / 8 != pixels)
    throw InputError({path, 0, "", "is no flow file, or a damaged one", "", "", ""});
  for (float value; take(left, value);) image.flow.push_back(value);
  return image;
}

}  // namespace rubble
