// A filter that takes the noise out of a path-traced image and leaves its edges.
//
// Light is divided by the albedo of what is seen, so that textures stay as they are, and averaged over
// ever wider surroundings (a-trous wavelets: Dammertz et al. 2010), where neighbours count as their
// normals, distances and, against the noise that is left, brightnesses agree (Schied et al. 2017).
// Before that, single pixels of large error that outshine all around them are brought down: they are paths
// of small chance and great light. It blurs what only the light draws, such as a fine shadow fainter than the noise: it is biased, as
// every such filter is, and vanishes as samples grow.
#pragma once

#include <vector>

#include "render/reference/traced_image.h"

namespace rubble {

// The light of each pixel. The result does not depend on the number of threads.
std::vector<Vec3f> denoise_image(const TracedImage& image, int threads);

}  // namespace rubble
