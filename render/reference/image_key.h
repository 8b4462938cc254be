// Names of path-traced images in the cache: hashes of all that an image follows from.
#pragma once

#include <string>

#include "render/reference/reference_pass.h"

namespace rubble {

// Of what stands there, how it looks and what lights it.
std::string surroundings_key(const ReferenceSurroundings& surroundings);
// Of one image of it; scene: where what moves is now.
std::string image_key(const std::string& surroundings, const PreparedScene& scene,
                      const LightSet& lights, const ReferenceOptions& options, const ViewRays& view, const LampSpec& lamp,
                      const Air& air);

}  // namespace rubble
