// Pictures of a void map: seen from above, and cut open.
#pragma once

#include <string>

#include "io/image/image_file.h"
#include "kernel/voids/void_map.h"

namespace rubble {

struct VoidPictureOptions {
  int long_side = 1400;  // of the drawing, without title and legend; unit: pixel; 200 to 8000
  double margin = 1.0;   // shown around the robot's voids; unit: m
  int labels = 12;       // voids whose entrances bear their rank; others have small arrows
  std::string title;     // ASCII
};

// From above, north (Y) up: the pile in grey by height, the voids of one robot coloured by how much
// free height is below each point, entrances as arrows with the rank of the void in voids.json.
// Only the part around the voids is shown.
// robot: index into map.robots.
RgbImage draw_void_plan(const VoidMap& map, std::size_t robot,
                        const VoidPictureOptions& options = {});

// A vertical cut through a point across the given axis (0: the plane of Y and Z, 1: of X and Z):
// solid dark, outside pale, void coloured by clearance, what the robot covers outlined, with
// entrances within 0.3 m of the cut as arrows.
RgbImage draw_void_cut(const VoidMap& map, std::size_t robot, int axis, const Vec3& through,
                       const VoidPictureOptions& options = {});

}  // namespace rubble
