// What cameras on robots show while the robots are driven: a renderer of its own, of the scene that goes on.
//
// Its pictures have the bits of the recorded ones, whose scene is lit in the same way then: build_live_scene().
#pragma once

#include "render/gl/gl_context.h"
#include "render/renderer.h"
#include "render/scene/scene.h"

namespace rubble {

struct LiveColoursOptions {
  int gl_device = -1;           // see GlContextOptions
  int threads = 1;
  Renderer::Progress progress;  // of the light
};

// The scene as it is drawn for cameras that are sensed.
class LiveColours {
 public:
  // scene: shows everything where the history of the sensors has it. The scenario's colours are drawn by the fast
  // renderer. Throws RunError as GlContext and Renderer do.
  LiveColours(const Scene& scene, const LiveColoursOptions& options);

  Renderer& renderer() { return renderer_; }

 private:
  GlContext gl_;
  Renderer renderer_;
};

}  // namespace rubble
