// Convex collision parts that hug the surface of a solid.
#pragma once

#include <vector>

#include "assets/generator/asset.h"
#include "assets/generator/surface_mesh.h"

namespace rubble::generator {

inline constexpr int kMaxCorners = 32;       // per part: the cost of contact grows with them
inline constexpr double kCornerGap = 0.006;  // corners farther off the surface are cut; unit: m

// The cells as they are.
std::vector<std::vector<Vec3>> cell_parts(const Solid& solid);

// One part per cell: its faces moved in until they touch the surface, then the corners that stick
// out farthest cut off, as long as the corners stay few. Contains the surface that is in the cell.
std::vector<std::vector<Vec3>> fit_parts(const Solid& solid, const SurfaceMesh& surface);

// The same for regions that need not be cells of the solid: each part holds the surface in its region
// (as sampled, before the warp), and is moved to where the warp puts it.
std::vector<std::vector<Vec3>> fit_regions(const Solid& solid, const std::vector<Cell>& regions,
                                           const SurfaceMesh& surface, const Warp& warp);

}  // namespace rubble::generator
