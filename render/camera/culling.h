// Which pieces can be seen: the view's frustum, back-facing clusters, and what lies behind depth
// that has been drawn. Every test errs towards "visible", so nothing that shows is ever dropped.
#pragma once

#include <cstddef>
#include <vector>

#include "kernel/base/math.h"
#include "render/camera/projection.h"

namespace rubble {

// Before any depth is known, the nearest pieces up to this many triangles are drawn.
inline constexpr std::size_t kFirstBatch = 150000;

// Depth-buffer values (near / Z; 0: nothing) as a pyramid of the farthest one in each tile.
class DepthPyramid {
 public:
  static constexpr int kTile = 4;  // side of the finest level's tiles; unit: pixel

  // depth: width * height values, rows from the top.
  void build(const float* depth, int width, int height);
  bool empty() const { return levels_.empty(); }

  // False only when all of the pixel rectangle (both ends included, clipped to the image) holds
  // something nearer than `nearest_value` = near / Z of the candidate's nearest point.
  bool may_show(int x0, int y0, int x1, int y1, float nearest_value) const;

 private:
  struct Level {
    int width = 0, height = 0;
    std::vector<float> farthest;
  };
  std::vector<Level> levels_;
};

// A pinhole view for sphere tests.
class ViewVolume {
 public:
  explicit ViewVolume(const ViewProjection& view);

  // Centre in the optical frame; unit: m.
  bool sphere_in_view(const Vec3f& centre, float radius) const;
  // A box by its centre and the vectors to the middles of three sides.
  bool box_may_show(const Vec3f& centre, const Mat3f& half_sides,
                    const DepthPyramid& pyramid) const;

 private:
  float fx_, fy_, cx_, cy_;
  int width_, height_;
  Vec3f planes_[4];  // inward normals through the eye
};

// True when every triangle of the cluster faces away from `eye` (all in the mesh frame).
bool faces_away(const Vec3f& eye, const Vec3f& centre, float radius, const Vec3f& cone_axis,
                float cone_cosine);

}  // namespace rubble
