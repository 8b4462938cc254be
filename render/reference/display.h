// From radiance to the display image, as the fast renderer does it: the same light meter, white balance
// and tone curve. The formulas of shaders/tone.glsl stand here again.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/base/math.h"
#include "render/lighting/exposure.h"

namespace rubble {

// light: red, green, blue of each pixel in kcd/m2; gains: of white balance.
MeteredImage meter_image(const std::vector<float>& light, int width, int height, const Vec3f& gains);

// 4 bytes a pixel, the last 255. exposure: what luminance in kcd/m2 is multiplied by.
std::vector<std::uint8_t> develop_image(const std::vector<float>& light, int width, int height,
                                        const Vec3f& gains, float exposure);

}  // namespace rubble
