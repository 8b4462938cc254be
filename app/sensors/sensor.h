// The sensors of a mission that measure. A recording, a session that is stepped and a function that drives a robot have the
// same ones, so what is told is what is recorded, bit for bit. A recording is the case in which everything is known.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "app/sensors/robot_readings.h"
#include "render/media/medium.h"
#include "render/rays/ray_world.h"
#include "render/scene/sample.h"
#include "scripting/scenario/scenario.h"
#include "scripting/trajectory/smooth_path.h"

namespace rubble {

class Sensor {
 public:
  virtual ~Sensor() = default;
  // What its next sample is, and what must be known for it: stamps.
  struct Needs {
    std::int64_t stamp = 0;      // of the sample; INT64_MAX: there is none
    std::int64_t end = 0;        // of what it measures, from the stamp on
    std::int64_t from = 0;       // of the way of its carrier, from here
    std::int64_t way_until = 0;  // to here
    std::int64_t scene_until = INT64_MIN;  // and of what moves in view; INT64_MIN: it sees nothing
  };
  virtual Needs needs() const = 0;
  virtual Sample take() = 0;
};

// Whether a sensor gives no more by that stamp: it gives samples up to there, and of what lasts only what is whole by then.
// Where nothing whole fits, it gives one all the same. taken: it gave one.
bool is_over(const Sensor::Needs& next, std::int64_t last_ns, bool taken);

// What the sensors of a recording or a session share. All of it must outlive them.
struct SensorParts {
  const Scenario& scenario;
  std::uint64_t noise_seed = 0;             // of the noise of all
  std::int64_t start_ns = 0;                // stamp of the time 0 of all ways
  const RobotReadings& robots;              // the ways of links, and their contacts
  std::shared_ptr<const MotionPath> rig;    // the way of the rig; null: nothing is known of it
  std::shared_ptr<RayWorld> rays;           // of those that see the scene, else null
  std::shared_ptr<const Medium> air;        // likewise
  int threads = 1;

  // The way of what is on `carrier`, or on the rig. Throws InputError, with the key of the sensor, where nothing carries it.
  const std::shared_ptr<const MotionPath>& way_of(const Carrier& carrier, const std::string& key) const;
};

// number: in the scenario's list. Both throw InputError where nothing carries it.
std::unique_ptr<Sensor> make_imu(const SensorParts& parts, std::size_t number);
std::unique_ptr<Sensor> make_sensor(const SensorParts& parts, std::size_t number);

}  // namespace rubble
