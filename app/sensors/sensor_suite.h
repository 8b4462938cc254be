// The sensors of a mission, ready to measure, each with its own rate and place on the rig.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "app/sensors/build_camera.h"
#include "render/renderer.h"
#include "render/scene/sample.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

// How a leg of a recording goes on from the one before.
struct SensorBegin {
  std::uint64_t noise_seed = 0;  // of all sensors
  std::vector<int> frames;       // number of each camera's first frame; empty: 0
};

// All sensors that ride on one rig, merged by stamp. At equal stamps inertial units come before LiDARs,
// and these before cameras, in the order of all_cameras(). The renderer must outlive them.
class SensorSuite {
 public:
  // flown: the scenario with the path that is flown, which `flight` was made from. scene: what the renderer
  // draws.
  SensorSuite(const Scenario& flown, const RigFlight& flight, const SensorBegin& begin, const Scene& scene,
              Renderer& renderer, int threads);

  // Frames of each camera over the whole flight.
  const std::vector<int>& frames() const { return frames_; }
  int count_frames() const;
  // The sample that comes next. Nothing: every camera has given its last frame.
  std::optional<Sample> take();

 private:
  std::vector<int> frames_;
  std::vector<std::unique_ptr<Sensor>> sensors_;
};

}  // namespace rubble
