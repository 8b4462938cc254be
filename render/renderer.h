// Draws views of a scene: colour, exact depth and ground truth of the same pose.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "render/camera/view_rays.h"
#include "render/device/device.h"
#include "render/media/medium.h"
#include "render/scene/frame.h"
#include "render/scene/scene.h"
#include "render/view/exposed_view.h"
#include "render/view/render_options.h"
#include "render/view/rendered_view.h"

namespace rubble {

class Renderer {
 public:
  // Called with the done fraction (0 to 1) while the scene is prepared.
  using Progress = std::function<void(double)>;

  // Prepares all that does not depend on the camera. The device must outlive the renderer and be used by one thread at
  // a time. Throws RunError for an unknown look or if memory is exhausted.
  Renderer(Device& device, const Scene& scene, const RenderOptions& options = {},
           const Progress& progress = {});
  ~Renderer();

  // Replaces the lamp and the air of the scene. Frames are those of a new Renderer, but light is not baked again. Earlier
  // views must not be used any more.
  void restart(const LampSpec& lamp, const AirSpec& air);

  // A view through any lens and shutter, exact for the ray of each pixel, without resampling. It draws on demand. Moving
  // instances have their poses at the stamp of the view, also if rows have times of their own. next: the view of the
  // next frame, for streams that need it; null: there is none.
  // The renderer must outlive the view. Throws RunError: sizes or focal lengths out of range.
  RenderedView view(const ViewRays& rays, const ViewRays* next = nullptr);
  // Whether RenderedView::begin() has an effect.
  bool runs_ahead() const;
  // For RenderedView::light_changes(). Null: the device does not find them; the view's radiance has the light. The device
  // must outlive it.
  std::shared_ptr<LightWatch> watch_light(const WatchedPixels& pixels);
  // Adds drops and flakes to the light of an exposure, 3 floats a pixel as in linear frames; unit: kcd/m2. No effect
  // without rain and snow.
  void add_drops(const ExposedView& exposed, std::vector<float>& radiance);
  // The air of the scene, for sensors that are not cameras. Valid until the next restart().
  const Medium& medium() const;

  // Colour and depth of a view. Exposure is metered on the frame itself, so a frame does not depend on earlier ones. Noise
  // follows from `index`, or for a view from ViewRays::noise. `intrinsics` must have zero distortion.
  Frame render(const Pose& world_from_camera, const Intrinsics& intrinsics, int index,
               std::int64_t stamp_ns);
  Frame render(const ViewRays& rays, int index);
  // The same of many poses, one after the other: index is that of the first, and each frame goes to `take`. A device that
  // runs ahead always has some to draw.
  void render(const std::vector<Pose>& world_from_camera, const Intrinsics& intrinsics, int index, std::int64_t stamp_ns,
              const std::function<void(Frame)>& take);
  LinearFrame render_linear(const Pose& world_from_camera, const Intrinsics& intrinsics);
  LinearFrame render_linear(const ViewRays& rays);

 private:
  std::unique_ptr<ViewSource> source_;
};

}  // namespace rubble
