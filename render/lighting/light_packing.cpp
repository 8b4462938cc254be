#include "render/lighting/light_packing.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace rubble {

std::uint16_t to_half(float x) {
  x = std::clamp(x, -60000.0f, 60000.0f);
  std::uint32_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  const std::uint32_t sign = bits >> 16 & 0x8000u;
  const int exponent = int(bits >> 23 & 0xff) - 127 + 15;
  const std::uint32_t mantissa = bits & 0x7fffffu;
  if (exponent <= 0) {
    if (exponent < -10) return std::uint16_t(sign);
    const int shift = 14 - exponent;
    const std::uint32_t full = mantissa | 0x800000u;
    return std::uint16_t(sign | ((full + (1u << (shift - 1))) >> shift));
  }
  return std::uint16_t(sign |
                       ((std::uint32_t(exponent) << 10 | mantissa >> 13) + (mantissa >> 12 & 1u)));
}

float from_half(std::uint16_t half) {
  const int exponent = half >> 10 & 31;
  const float mantissa = float(half & 1023);
  const float size = exponent ? std::ldexp(1024 + mantissa, exponent - 25)
                              : std::ldexp(mantissa, -24);
  return half & 0x8000u ? -size : size;
}

UnpackedLight unpack_light(const BakedLight& light, const Vec3f& normal) {
  const Vec3f vector(from_half(light.x), from_half(light.y), from_half(light.z));
  const float red = float(light.red) / 255, blue = float(light.blue) / 255;
  return {vector, Vec3f(red, 1 - red - blue, blue) * (3 * std::max(dot(vector, normal), 0.0f))};
}

BakedLight pack_light(const Vec3f& vector, const Vec3f& colour) {
  BakedLight out;
  out.x = to_half(vector.x), out.y = to_half(vector.y), out.z = to_half(vector.z);
  const float sum = colour.x + colour.y + colour.z;
  if (sum > 0) {
    out.red = std::uint8_t(std::lround(255 * colour.x / sum));
    out.blue = std::uint8_t(std::lround(255 * colour.z / sum));
  }
  return out;
}

}  // namespace rubble
