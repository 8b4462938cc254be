// Images of vectors, such as normals and flow, as colours for viewers that know pictures of bytes alone.
#pragma once

#include <cstdint>
#include <vector>

#include "render/scene/image_stream.h"

namespace rubble {

// Three bytes a pixel; black where a value is NaN.
//   unit vectors (three values without a unit)   each value from -1 to 1 as 0 to 255: a normal towards the camera is olive
//   directions (two values)                      hue by the angle, from red along +X over green to blue; white for 0, full
//                                                colour from 1/16 of the width on
//   places (three values with a unit)            each value's part of a whole unit as 0 to 255
// values: of the stream, which has two or three a pixel; width: of the picture, unit: pixel.
std::vector<std::uint8_t> colour_vectors(const ImageStream& stream, const std::vector<float>& values, int width);

}  // namespace rubble
