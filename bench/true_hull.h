// A convex hull for the judge of overlaps: found by trying every plane through three points, in
// double precision. Slow and plain on purpose; it shares no code with the kernel's collision.
#pragma once

#include <vector>

#include "kernel/base/math.h"

namespace rubble {

// In the frame of the piece's type, scale 1.
struct TrueHull {
  struct Face {
    Vec3 normal;            // unit length, outwards
    std::vector<int> loop;  // corners, counter-clockwise seen from outside
  };
  std::vector<Vec3> corners;          // unit: m
  std::vector<Face> faces;            // none twice; what lies in one plane is one face
  std::vector<Vec3> face_normals;     // unit length; one of each pair of opposite ones
  std::vector<Vec3> edge_directions;  // unit length; one of each set of parallel ones
};

// Throws std::invalid_argument when the points do not span a volume.
TrueHull make_true_hull(const std::vector<Vec3>& points);

// The same scaled and placed in the world.
struct PlacedHull {
  TrueHull hull;
  Vec3 middle;  // of the corners; unit: m
  Aabb box;     // unit: m
};
PlacedHull place_hull(const TrueHull& hull, double scale, const Pose& world_from_body);

}  // namespace rubble
