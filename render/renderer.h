// Draws frames of a scene: colour and exact depth of the same pose.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "render/camera/view_rays.h"
#include "render/gl/gl_context.h"
#include "render/materials/surface_appearance.h"
#include "render/scene/camera_spec.h"
#include "render/scene/frame.h"
#include "render/scene/scene.h"

namespace rubble {

// Who draws the triangles, see passes/triangle_raster.h. automatic: the graphics device, unless it
// is a software driver.
enum class RasterChoice { automatic, device, processor };

struct RenderOptions {
  // Where textures and baked light are kept from run to run, see DiskCache; "": nowhere.
  std::string cache_folder;
  int threads = 1;         // for preparing and baking; the result does not depend on it
  bool bake = true;        // light by way of the sky and other surfaces; false: open sky everywhere
  int bake_rays = 256;     // a bake point at most; range: 8 to 1024
  int shadow_size = 4096;  // side of the main light's shadow map; unit: texel
  int texture_size = 512;  // side of the procedural textures; a power of two
  RasterChoice raster = RasterChoice::automatic;
  bool occlusion_culling = true;
  double coarse_below = 0;    // allow coarser levels for triangles about this small; unit: pixel;
                              // 0: the finest always, so that depth is that of the true surface
  bool antialias = true;      // smooth silhouettes of the colour image
  double fixed_exposure = 0;  // factor on luminance in kcd/m2; 0: automatic
  ColourSpec colour;          // fast, or path traced
  // Of a path-traced image: called on the calling thread with its done fraction; may throw to stop.
  std::function<void(double)> image_progress;
};

// The same view before exposure and tone mapping, for tests and sensors.
struct LinearFrame {
  int width = 0, height = 0;
  std::vector<float> rgb;               // radiance; unit: kcd/m2
  std::vector<float> depth;             // as in Frame
  std::vector<float> distance;          // the same along each pixel's ray
  std::vector<std::uint32_t> instance;  // SceneInstance::id; kNoInstance, kGroundInstance
};

// What a pass of the last frame took. Where other programs share the processors only the processor
// time means something.
struct PassTime {
  double elapsed = 0;    // unit: ms
  double processor = 0;  // of all threads of this program; unit: ms
};

struct RenderTimes {
  PassTime visibility;  // which triangle each pixel shows
  PassTime resolve;     // colours
  PassTime read;        // the image back from the device
  PassTime finish;      // smooth edges, metric depth
  std::size_t triangles = 0;
};

class Renderer {
 public:
  // Called with the done fraction (0 to 1) while the scene is prepared.
  using Progress = std::function<void(double)>;

  // Prepares everything that does not depend on the camera. The context must outlive the renderer
  // and be used by one thread at a time. Throws RunError: unknown look, out of memory.
  Renderer(GlContext& context, const Scene& scene, const RenderOptions& options = {},
           const Progress& progress = {});
  ~Renderer();

  // Another lamp and other air over the same scene: the frames are those of a new Renderer for it, but
  // light that was baked is not baked again.
  void restart(const LampSpec& lamp, const AirSpec& air);

  // What moves in the scene is where it is at the stamp of the view; of a view whose rows have times of
  // their own, all rows see it there.
  // Metered on the frame itself: a frame is the same whichever were drawn before it. Distortion in
  // `intrinsics` is not applied: it must be zero.
  Frame render(const Pose& world_from_camera, const Intrinsics& intrinsics, int index,
               std::int64_t stamp_ns);
  // The same through any lens and shutter: exact for each pixel's own ray, without resampling.
  Frame render(const ViewRays& view, int index);
  // Colour of another view at the same instant, at the exposure of the frame drawn last.
  std::vector<std::uint8_t> render_stereo_right(const ViewRays& view);
  // Adds streams of ground truth to a frame of the view that was drawn last. next: the view of the
  // frame that follows, for streams that need it; null: none follows.
  void add_truth(const StreamSet& streams, const ViewRays* next, Frame& frame);
  // Of the view that was drawn last: distances along the rays (NaN: none), and 1 where a place in the
  // camera body frame has a free line to the surface.
  std::vector<float> distances() const;
  std::vector<std::uint8_t> line_of_sight_mask(const Vec3& place_in_camera);
  // Of the same view: each surface's share of light just beyond red that it throws back; 0: none.
  std::vector<float> albedos() const;
  // Of the same view: how far each pixel's surface moves until another stamp, in the world; empty where
  // nothing in the scene moves, zero where nothing is seen or it is not there then. unit: m
  std::vector<Vec3f> shifts(std::int64_t stamp_ns) const;
  LinearFrame render_linear(const Pose& world_from_camera, const Intrinsics& intrinsics);
  LinearFrame render_linear(const ViewRays& view);

  const RenderTimes& times() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace rubble
