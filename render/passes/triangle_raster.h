// Which triangle each pixel shows, and its depth, as a device finds them.
//
// All give the depth of the triangle's plane under the pixel's centre, exact within the rounding of
// floats at any distance and slant, whatever a device interpolates.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "render/camera/projection.h"

namespace rubble {

// Neighbouring clusters of a placed mesh.
struct ClusterRun {
  std::uint32_t placed, first_cluster, cluster_count;  // number of the mesh, and its clusters
};

// A placed mesh that may be in view, and its level of detail.
struct DrawCandidate {
  std::uint32_t placed, level;
};

// The images of a view that lie on a device while others are drawn. The raster must outlive them.
class LeftImages {
 public:
  virtual ~LeftImages() = default;
  virtual const std::vector<float>& depth_values() = 0;  // each as TriangleRaster has it
  virtual std::vector<std::uint32_t> ids() = 0;
  virtual std::size_t triangles() = 0;
};

class TriangleRaster {
 public:
  virtual ~TriangleRaster() = default;

  virtual void begin(const ViewProjection& view) = 0;  // clears; the view must outlive the drawing
  virtual void draw(const std::vector<ClusterRun>& runs) = 0;
  // Draws of these what shows, as VisibilityPass would choose it, so that nothing has to come back from the device. Nearest
  // first. False: it does not do that.
  virtual bool draw_what_shows(const std::vector<DrawCandidate>& candidates) { return (void)candidates, false; }
  virtual std::size_t read_triangles() const { return 0; }  // that it drew then
  // near / Z (0: nothing) of what was drawn since begin(), rows from the top; good enough to cull by. Not to be asked of one
  // that draws what shows.
  virtual const std::vector<float>& depth_so_far() { return depth_values(); }
  // Ends the image: from now on what follows is there, until the next begin().
  virtual void finish() = 0;

  virtual const std::vector<float>& depth_values() const = 0;  // near / Z, exact
  // Two numbers a pixel: placed mesh + 1 (0: nothing) and the triangle's name. Null: they lie on the device alone.
  virtual const std::uint32_t* ids() const = 0;
  virtual std::vector<std::uint32_t> read_ids() const = 0;  // the same, copied from there
  // What finish() ended, to be read after the next begin(). Null: it must be read before.
  virtual std::unique_ptr<LeftImages> leave() { return nullptr; }
};

}  // namespace rubble
