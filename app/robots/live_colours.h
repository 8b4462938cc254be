// What cameras on robots show while the robots are driven: the pictures of their sensors, developed.
//
// A picture is drawn when its exposure has ended, and the robots' time is two steps later. Where nothing moves but
// what carries the camera, it has the bits of the recorded one; else see LiveSteps::pose_of(), and light on what may
// move is found anew for every picture here, baked there for what rested.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "app/robots/live_ranges.h"
#include "app/robots/live_steps.h"
#include "render/gl/gl_context.h"
#include "render/renderer.h"
#include "render/scene/scene.h"
#include "render/sensors/camera.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

struct SensedColours {
  std::int64_t stamp_ns = 0;
  std::size_t camera = 0;  // number among all_cameras()
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // row by row from the top
};

struct LiveColoursOptions {
  int gl_device = -1;           // see GlContextOptions
  int threads = 1;
  double step = 0;              // of the robots; unit: s
  Renderer::Progress progress;  // of the light
};

class LiveColours {
 public:
  // scene: as for LiveRanges. The scenario's colours are drawn by the fast renderer. Throws RunError as GlContext and
  // Renderer do.
  LiveColours(const Scenario& scenario, const std::vector<RidingSensor>& cameras, const Scene& scene,
              const LiveColoursOptions& options);
  ~LiveColours();

  void restart(const World& world) { steps_.restart(world); }  // at the robots' time 0; once
  void note_step(const World& world) { steps_.note_step(world); }  // after each step
  // All since the last call, camera by camera in the order of stamps.
  std::vector<SensedColours> take();

  // While pictures are drawn: where a piece or a link was; nothing: it was not there.
  bool measuring() const { return steps_.measuring(); }
  std::optional<Pose> pose_of(int id, std::int64_t stamp_ns) const { return steps_.pose_of(id, stamp_ns); }

 private:
  struct Eye {
    std::size_t number = 0, carrier = 0;
    MountedCamera mounted;
    double rate_hz = 0;
    std::int64_t half_ns = 0;  // from the start of an exposure to its stamp, and from there to its end, at most
    std::unique_ptr<Camera> camera;
    int next = 0;
    std::int64_t stamp_ns(std::int64_t start_ns) const;  // of the next picture
  };
  void draw(Eye& eye, std::vector<SensedColours>& pictures);

  LiveSteps steps_;
  GlContext gl_;
  Renderer renderer_;
  std::vector<Eye> eyes_;
};

}  // namespace rubble
