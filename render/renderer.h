// Draws views of a scene: colour, exact depth and ground truth of the same pose.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "render/camera/view_rays.h"
#include "render/gl/gl_context.h"
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

  // Prepares everything that does not depend on the camera. The context must outlive the renderer
  // and be used by one thread at a time. Throws RunError: unknown look, out of memory.
  Renderer(GlContext& context, const Scene& scene, const RenderOptions& options = {},
           const Progress& progress = {});
  ~Renderer();

  // Another lamp and other air over the same scene: the frames are those of a new Renderer for it, but
  // light that was baked is not baked again. Views that were made before must not be asked any more.
  void restart(const LampSpec& lamp, const AirSpec& air);

  // A view through any lens and shutter, exact for each pixel's own ray, without resampling. Nothing is
  // drawn until it is asked. What moves in the scene is where it is at the stamp of the view; of a view
  // whose rows have times of their own, all rows see it there.
  // next: the view of the frame that follows, for streams that need it; null: none follows.
  // The renderer must outlive the view. Throws RunError: sizes or focal lengths out of range.
  RenderedView view(const ViewRays& rays, const ViewRays* next = nullptr);
  // Adds the drops and flakes that fall through an exposure to its light, 3 floats a pixel (unit: kcd/m2), which is
  // that of linear frames. Nothing where nothing falls.
  void add_drops(const ExposedView& exposed, std::vector<float>& radiance);
  // What hangs in the air of the scene, for sensors that are not cameras. Until the next restart().
  const Medium& medium() const;

  // Colour and depth of a view, metered on the frame itself: a frame is the same whichever were drawn
  // before it. Its noise follows from `index`, or of a view from ViewRays::noise. Distortion in `intrinsics` is not applied: it must be zero.
  Frame render(const Pose& world_from_camera, const Intrinsics& intrinsics, int index,
               std::int64_t stamp_ns);
  Frame render(const ViewRays& rays, int index);
  LinearFrame render_linear(const Pose& world_from_camera, const Intrinsics& intrinsics);
  LinearFrame render_linear(const ViewRays& rays);

 private:
  std::unique_ptr<ViewSource> source_;
};

}  // namespace rubble
