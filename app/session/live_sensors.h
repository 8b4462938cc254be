// Sensors on robots that are measured while the robots are driven. They give what those that record give, bit for bit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "app/session/pose_history.h"
#include "render/lidar/lidar_world.h"
#include "render/media/medium.h"
#include "render/scene/sample.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

class LiveSensor {
 public:
  virtual ~LiveSensor() = default;
  // What must be known for the next sample: stamps.
  struct Needs {
    std::int64_t from = 0;       // of the way of its carrier, from here
    std::int64_t way_until = 0;  // to here
    std::int64_t scene_until = INT64_MIN;  // and of what moves in view; INT64_MIN: it sees nothing
  };
  virtual Needs needs() const = 0;
  virtual Sample take() = 0;
};

// What the sensors of a session share. All of it must outlive them.
struct LiveSensorParts {
  const Scenario& scenario;
  const PoseHistory& history;
  std::shared_ptr<LidarWorld> world;  // of a scene that shows everything where the history has it; none: units of inertia alone
  Medium medium;
  int threads = 1;
};

// number: in the scenario's list. All throw InputError where no robot carries it.
std::unique_ptr<LiveSensor> make_live_imu(const LiveSensorParts& parts, std::size_t number);
std::unique_ptr<LiveSensor> make_live_reading(const LiveSensorParts& parts, std::size_t number);
std::unique_ptr<LiveSensor> make_live_lidar(const LiveSensorParts& parts, std::size_t number);
// Planar depth by exact rays, without noise and without what the air does to depth sensors: frames of depth alone.
// Throws InputError for a lens that is no pinhole.
std::unique_ptr<LiveSensor> make_live_depth(const LiveSensorParts& parts, std::size_t number);

}  // namespace rubble
