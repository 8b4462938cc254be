// A channel of a frame as a picture for people.
#pragma once

#include <string>

#include "io/image/image_file.h"
#include "render/scene/camera_spec.h"

namespace rubble {

// Switches on what the channel needs: colour, depth, normals, instance, label, flow, sky_visibility,
// measured_depth, events, right. Throws RunError for another name.
void ask_for_channel(const std::string& channel, CameraSpec& spec);

// depth: near is yellow, far is blue, by the logarithm of the distance, nothing is black. normals: as
// usual, (n + 1) / 2. instance, label: a colour of its own for each number. flow: direction as hue,
// length as saturation. sky_visibility: black to white. events: brighter red, darker blue, on grey.
// right: the right image of the pair above the left one's place, as red and cyan of one picture.
RgbImage channel_picture(const std::string& channel, const Frame& frame);

}  // namespace rubble
