// OpenEXR pictures of exact numbers: depth, normals, piece numbers.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace rubble {

// OpenCV's reader knows a single channel by the name Y alone, and three as R, G and B.
// Interleaved values of some channels, rows from the top; `channels` names them in that order.
// The bytes of an EXR file with ZIP compression, lossless, NaN included. Throws RunError.
std::string encode_exr(int width, int height, const std::vector<std::string>& channels,
                       const std::vector<float>& values);

// The same values again, as numbers that hold each of them exactly. Throws InputError for a file
// that is missing, damaged, or without these channels.
struct ExrImage {
  int width = 0, height = 0;   // unit: pixel
  std::vector<double> values;  // interleaved, rows from the top
};
ExrImage read_exr(const std::string& path, const std::vector<std::string>& channels);

}  // namespace rubble
