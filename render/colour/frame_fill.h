// The numbers that are the same for all pixels of an image, for either way of shading.
#pragma once

#include "render/camera/projection.h"
#include "render/colour/frame_light.h"
#include "render/geometry/ground_map.h"
#include "render/shading/frame_block.h"

namespace rubble {

inline constexpr double kVeilFrom = 12;  // where the clean air begins to veil what is seen; unit: m

// bearer: of the lamp. texture_size: side of the looks' textures; unit: texel.
FrameBlock fill_frame_block(const ViewProjection& view, const FrameLight& light, const Pose& bearer,
                            const GroundMap& ground, int texture_size, float exposure);

bool has_lamp(const FrameLight& light);
// Whether light changes an 8-bit image. white_radiance: the most that a matt white surface sends of it.
bool light_shows(const FrameLight& light, float white_radiance, float exposure);
// Whether the lamp changes an 8-bit image: in daylight it adds less than its steps can show.
// lamp_offset: from the eye to the lamp; unit: m. nearest_value: the largest depth value of the
// image.
bool lamp_shows(const FrameLight& light, double lamp_offset, float nearest_value, float exposure);

}  // namespace rubble
