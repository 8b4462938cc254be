// Optical flow as a Middlebury .flo file (https://vision.middlebury.edu/flow/data/).
#pragma once

#include <string>
#include <vector>

#include "io/little_endian.h"

namespace rubble {

// flow: 2 a pixel, rows from the top; NaN, where there is none, becomes the format's mark for that.
inline std::string encode_flow(int width, int height, const std::vector<float>& flow) {
  constexpr float kUnknown = 1666666752.0f;  // readers take all above 1e9 for unknown
  std::string bytes;
  bytes.reserve(12 + flow.size() * sizeof(float));
  put(bytes, 202021.25f);  // "PIEH"
  put(bytes, width);
  put(bytes, height);
  for (const float value : flow) put(bytes, value == value ? value : kUnknown);
  return bytes;
}

}  // namespace rubble
