// Polygons of a file as triangles.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

// Indices into the corners, in their sense of turning. A convex polygon is a fan about its first corner; others are
// cut by ear clipping in the plane of their area. A polygon that no plane explains is a fan. Empty below 3 corners.
std::vector<std::array<std::uint32_t, 3>> triangulate(const std::vector<Vec3>& corners);

}  // namespace rubble
