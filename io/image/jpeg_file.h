// JPEG pictures in memory.
#pragma once

#include <cstdint>
#include <string>

namespace rubble {

// The bytes of a JPEG file of 3 bytes a pixel, rows from the top. quality: 1 to 100. Throws
// RunError.
std::string encode_jpeg(int width, int height, const std::uint8_t* rgb, int quality = 90);

}  // namespace rubble
