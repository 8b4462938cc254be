// The sensors of a mission, ready to measure, each with its own rate and place on the rig.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "app/sensors/build_camera.h"
#include "app/sensors/robot_readings.h"
#include "render/renderer.h"
#include "render/scene/sample.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

// How a leg of a recording goes on from the one before.
struct SensorBegin {
  std::uint64_t noise_seed = 0;  // of all sensors
  std::vector<int> frames;       // number of each camera's first frame; empty: 0
};

// All sensors, on the rig or on links of robots, and what robots sense, merged by stamp. At equal stamps robots come
// before inertial units, these before LiDARs, and these before cameras, in the order of all_cameras(). The
// renderer and the readings must outlive them.
class SensorSuite {
 public:
  // flown: the scenario with the path that is flown, which `flight` was made from. scene: what the renderer
  // draws.
  SensorSuite(const Scenario& flown, const RigFlight& flight, const SensorBegin& begin, const Scene& scene,
              Renderer& renderer, int threads, const RobotReadings& robots);

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
