// The sensors of a mission, each with its own rate and pose on the rig.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "app/sensors/build_camera.h"
#include "app/sensors/camera_renderers.h"
#include "app/sensors/robot_readings.h"
#include "app/sensors/sensor.h"
#include "render/scene/sample.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

// State in which a leg of a recording continues the previous one.
struct SensorBegin {
  std::uint64_t noise_seed = 0;  // of all sensors
  std::vector<int> frames;       // number of each camera's first frame; empty: 0
  bool followed = false;         // by a leg: what sees nothing measures to the end of the rig's way
};

// All sensors on the rig and on links of robots, and the readings of robots, merged by stamp. Each ends with the way of its
// carrier, and all end with the last frame. Robots and inertial units go on to their first sample that is not before it, so
// that their readings about the last picture and the last scan are known, also of a flight that is shorter than a scan. Before another leg, what sees nothing goes on to
// the end of its way. Samples with equal stamps
// come in this order: robots, inertial units, other sensors, cameras, each in the order of the scenario. The renderers and the
// readings must outlive the suite.
class SensorSuite {
 public:
  // flight: of the scenario's cameras. robots: empty before they are driven: what they carry is not there then. scene: the scene of the renderers.
  SensorSuite(const Scenario& scenario, const RigFlight& flight, const SensorBegin& begin, const Scene& scene,
              CameraRenderers& renderers, int threads, const RobotReadings& robots);

  // Number of frames of each camera in the flight.
  const std::vector<int>& frames() const { return frames_; }
  int count_frames() const;
  // The next sample. Empty: every camera has given its last frame.
  std::optional<Sample> take();

 private:
  struct Member {
    std::unique_ptr<Sensor> sensor;
    std::int64_t last_ns = 0;  // no sample begins later
    bool taken = false;        // whether it has given one
  };
  std::vector<int> frames_;
  std::vector<Member> members_;
};

}  // namespace rubble
