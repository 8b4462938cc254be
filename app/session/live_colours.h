// What cameras on robots show while the robots are driven: renderers of their own, of the scene that goes on.
//
// Its pictures have the bits of the recorded ones, which are drawn by such renderers of a scene that is lit in the same way
// then: build_live_scene().
#pragma once

#include "app/sensors/camera_renderers.h"
#include "render/scene/scene.h"

namespace rubble {

struct LiveColoursOptions {
  int threads = 1;
  Renderer::Progress progress;  // of the light
};

// The scene as it is drawn for cameras that are sensed.
class LiveColours {
 public:
  // scene: shows everything where the history of the sensors has it. drawn: numbers of the cameras. Throws RunError as
  // Renderer does.
  LiveColours(std::unique_ptr<Device> device, const Scene& scene, const std::vector<MountedCamera>& cameras,
              const std::vector<std::size_t>& drawn, const LiveColoursOptions& options)
      : device_(std::move(device)),
        renderers_(scene, cameras, drawn, *device_, {options.threads, options.progress, {}}) {}

  Renderer& renderer_of(std::size_t camera) { return renderers_.of(camera); }

 private:
  std::unique_ptr<Device> device_;
  CameraRenderers renderers_;
};

}  // namespace rubble
