// What a view shows behind its sheets of glass, found by casting rays through the pixels that show glass: nothing where
// it shows none.
#pragma once

#include <cstdint>
#include <vector>

#include "render/camera/view_rays.h"
#include "render/geometry/scene_tables.h"
#include "render/geometry/glass_sheets.h"
#include "render/geometry/scene_rays.h"

namespace rubble {

// The image of the view with one more sheet of glass taken away where there is one, else that of the layer before.
struct GlassLayer {
  static constexpr float kDark = -1e-30f;  // a depth value: the inside of a thing, from which no light comes
  static constexpr int kBlock = 4;         // side; unit: pixel

  std::vector<std::uint32_t> ids;    // two a pixel, as TriangleRaster::ids()
  std::vector<float> depth_values;   // near / Z as RayPass has them for rays; 0: nothing
  std::vector<std::uint8_t> blocks;  // in rows, of kBlock x kBlock pixels: 1 where a sheet was taken away
  int blocks_across = 0;
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  // all of those are in columns [x0, x1) and rows [y0, y1); unit: pixel
};

class GlassRays {
 public:
  static constexpr std::size_t kMostLayers = 3;  // sheets behind as many are not there

  // What they refer to must outlive it.
  GlassRays(const PreparedScene& scene, const TriangleNames& names, SceneRays& rays, int threads);

  // Outermost first; none: no pixel shows glass. ids, depth_values: of the view, as in GlassLayer.
  std::vector<GlassLayer> find(const ViewRays& view, const std::uint32_t* ids, const std::vector<float>& depth_values);

 private:
  struct Pixel {
    std::uint32_t index;
    int u, v;  // column and row
  };
  bool shows_glass(const std::uint32_t* ids) const;
  bool begin_layer(const ViewRays& view, const std::uint32_t* ids, GlassLayer& out);  // finds pixels_
  void cast(const RayScene& solid, const ViewRays& view, const Pixel& pixel, bool last, GlassLayer& out) const;

  const PreparedScene& scene_;
  const TriangleNames& names_;
  int threads_;
  SceneRays& rays_;
  GlassSheets sheets_;
  std::vector<Pixel> pixels_;
};

}  // namespace rubble
