// What cameras on robots show while the robots are driven: the pictures of their sensors, developed.
//
// A picture is drawn when its exposure has ended. It has the bits of the recorded one, whose scene is lit in the same way
// then: build_live_scene().
#pragma once

#include <memory>
#include <vector>

#include "app/session/live_sensors.h"
#include "render/gl/gl_context.h"
#include "render/renderer.h"
#include "render/scene/scene.h"
#include "scripting/scenario/scenario.h"

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

  // Frames of colour alone. number: in the scenario's list. This must outlive the sensor. Throws InputError where no robot
  // carries it.
  std::unique_ptr<LiveSensor> make_eye(const LiveSensorParts& parts, std::size_t number);

 private:
  GlContext gl_;
  Renderer renderer_;
};

}  // namespace rubble
