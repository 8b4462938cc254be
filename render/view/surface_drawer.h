// Which triangle each pixel of a view shows: by rasterising where that will do, by casting rays
// otherwise. Internal to render/.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "render/camera/view_rays.h"
#include "render/passes/glass_layers.h"
#include "render/passes/ray_pass.h"
#include "render/colour/colour_pass.h"
#include "render/passes/visibility_pass.h"
#include "render/view/lit_scene.h"

namespace rubble {

class DrawnSurfaces;

class SurfaceDrawer {
 public:
  explicit SurfaceDrawer(LitScene& scene);

 private:
  friend class DrawnSurfaces;

  LitScene& scene_;
  TriangleRaster& raster_;     // of the device
  VisibilityPass visibility_;  // draws into that
  std::unique_ptr<RayPass> rays_;     // made when a view first needs it
  std::unique_ptr<GlassRays> glass_;  // likewise
  // Whose the images of the two passes are now.
  DrawnSurfaces* in_visibility_ = nullptr;
  DrawnSurfaces* in_rays_ = nullptr;
};

// The surfaces of one view. They lie in the images of a pass until that pass draws another view, which
// saves them first.
class DrawnSurfaces {
 public:
  // Draws. The drawer must outlive the surfaces.
  DrawnSurfaces(SurfaceDrawer& drawer, const ViewRays& view);
  ~DrawnSurfaces();
  DrawnSurfaces(const DrawnSurfaces&) = delete;
  DrawnSurfaces& operator=(const DrawnSurfaces&) = delete;

  // Where colours are shaded; until another view is drawn. With what is behind glass, for which the scene must be at
  // the moment of the view.
  SurfaceImages images();
  // Of images(): depth values of the farthest that is seen in each pixel, through glass.
  const std::vector<float>& depth_behind();
  const std::vector<std::uint32_t>& ids();            // two a pixel, as TriangleRaster::ids()
  std::vector<LampBounce::Shown> shown();              // the triangles in images(), some more than once
  // The placed meshes in images(), each once, in order; nothing: that is known on the device alone.
  std::optional<std::vector<std::uint32_t>> shown_pieces();
  // A device has them, and to read them back waits for it.
  bool on_device_alone() const { return in_raster() && !drawer_.raster_.ids(); }
  const std::vector<float>& depth_values();           // near / Z; as RayPass has them for rays
  const std::vector<float>& planar_depth();           // NaN: nothing; unit: m
  const std::vector<float>& distances();              // along the rays; NaN: nothing; unit: m
  // The same, given away.
  std::vector<float> take_planar_depth();
  std::vector<float> take_distances();
  std::size_t triangles();                            // drawn; 0: rays were cast

 private:
  void draw();
  void save();
  bool in_pass() const;
  bool in_raster() const { return drawer_.in_visibility_ == this; }
  const std::uint32_t* ids_in_place();  // the same where they lie; null: on the device alone
  SurfaceImages front_images();
  void find_behind(const std::uint32_t* ids);

  SurfaceDrawer& drawer_;
  ViewRays view_;
  std::optional<std::size_t> triangles_;
  std::vector<std::uint32_t> ids_;  // each empty until first asked for
  std::vector<float> planar_depth_, distances_;
  std::vector<float> saved_depth_values_;
  std::unique_ptr<LeftImages> left_;  // another view is drawn, and the device has the images of this one
  std::vector<GlassLayer> behind_;  // glass
  bool found_behind_ = false;
};

}  // namespace rubble
