// sRGB's transfer function (IEC 61966-2-1), with the same bits for every libm.
#pragma once

#include <algorithm>
#include <cstdint>

#include "kernel/base/portable_math.h"

namespace rubble {

// Both for 0 to 1: code values and linear light.
inline double linear_from_srgb(double code) {
  return code <= 0.04045 ? code / 12.92 : portable::exp(2.4 * portable::log((code + 0.055) / 1.055));
}
inline double srgb_from_linear(double x) {
  return x <= 0.0031308 ? 12.92 * x : 1.055 * portable::exp(portable::log(x) / 2.4) - 0.055;
}

// Linear light of any size to the nearest of 8 bits.
inline std::uint8_t srgb8_from_linear(double x) {
  return std::uint8_t(srgb_from_linear(std::clamp(x, 0.0, 1.0)) * 255 + 0.5);
}

}  // namespace rubble
