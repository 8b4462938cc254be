// A camera on its flight: exact frames of the renderer, then the stages that a real one adds.
//
//   lens, shutter -> exact light, depth, ground truth -> optics -> exposure -> image sensor -> rgb
//                                                     -> depth sensor -> measured_depth
//                                                     -> event camera -> events
//
// A stage that the specification leaves off does nothing and costs nothing; with all of them off a
// frame is Renderer::render's, bit for bit. Frames must be taken in order, from the first on.
#pragma once

#include <memory>

#include "render/renderer.h"
#include "render/scene/camera_spec.h"
#include "render/sensors/flight.h"

namespace rubble {

class Camera {
 public:
  // The renderer must outlive the camera. Throws RunError for a specification that contradicts itself.
  Camera(Renderer& renderer, const CameraSpec& spec, Flight flight);
  ~Camera();

  int frames() const;
  Frame take(int index);
  // A frame more, for a flight that is being flown. What needs the way after a frame (flow, rolling
  // shutter, motion blur) must be off then.
  void fly_on(std::int64_t stamp_ns, const Pose& world_from_camera);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace rubble
