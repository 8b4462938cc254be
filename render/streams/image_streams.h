// The table of all image streams. docs/development/contributing.md says how to add one: its file, and its name in
// RUBBLE_STREAMS of render/streams/CMakeLists.txt, which makes the table.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/scene/frame.h"
#include "render/scene/image_stream.h"

namespace rubble {

// In the order of RUBBLE_STREAMS: what the camera's model makes, then ground truth.
const std::vector<ImageStream>& image_streams();

// Those of ground truth, which camera.channels may name.
std::vector<const ImageStream*> truth_streams();
// null: no stream has that name.
const ImageStream* find_image_stream(const std::string& name);

// Where its values lie in the frame; nothing: the frame has none.
std::optional<ImageView> find_image(const Frame& frame, const ImageStream& stream);

}  // namespace rubble
