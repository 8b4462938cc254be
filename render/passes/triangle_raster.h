// Which triangle each pixel shows, and its depth: by the graphics device, or by the processor where
// the device is a software driver, which is slower at small triangles.
//
// Both give the depth of the triangle's plane under the pixel's centre, exact within the rounding of
// floats at any distance and slant, whatever a device interpolates.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "render/camera/projection.h"
#include "render/geometry/geometry.h"
#include "render/raster/software_raster.h"

namespace rubble {

class TriangleRaster {
 public:
  virtual ~TriangleRaster() = default;

  virtual void begin(const ViewProjection& view) = 0;  // clears; the view must outlive the drawing
  virtual void draw(const std::vector<ClusterRun>& runs) = 0;
  // near / Z (0: nothing) of what was drawn since begin(), rows from the top; good enough to cull by.
  virtual const std::vector<float>& depth_so_far() = 0;
  // Ends the image: from now on what follows is there.
  virtual void finish() = 0;

  virtual const std::vector<float>& depth_values() const = 0;  // near / Z, exact
  virtual const GlTexture& depth() const = 0;                  // the same
  virtual const GlTexture& ids() const = 0;  // placed mesh + 1 (0: nothing), triangle's name
  virtual std::vector<std::uint32_t> read_ids() const = 0;     // two numbers a pixel
  // The same where they lie, until the next begin(); null: only on the device.
  virtual const std::uint32_t* id_values() const { return nullptr; }
};

std::unique_ptr<TriangleRaster> make_gl_raster(const Gl& gl, const PreparedScene& scene,
                                               const GpuGeometry& geometry);
// textures: false: ids() and depth() stay empty.
std::unique_ptr<TriangleRaster> make_software_raster(const Gl& gl, const PreparedScene& scene,
                                                     const GpuGeometry& geometry, int threads, bool textures);

}  // namespace rubble
