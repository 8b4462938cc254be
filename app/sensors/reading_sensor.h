// Sensors of the kinds of scripting/sensors on a recording: what is around each, and its readings in order.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/sensors/robot_readings.h"
#include "render/lidar/lidar_world.h"
#include "render/scene/sample.h"
#include "scripting/scenario/scenario.h"
#include "scripting/trajectory/motion_path.h"

namespace rubble {

// What a sensor asks, of a mission. path: of its carrier, from start_ns on; world: null where it casts no rays. All must outlive the site.
// forces: as SensorSite::contact_force.
SensorSite make_sensor_site(const Scenario& scenario, std::int64_t start_ns, const SensorItem& sensor, const MotionPath& path, LidarWorld* world,
                            std::function<double(const std::vector<std::string>&, double, double)> forces = {});

// Of the sensor of that number in the scenario; robots: must outlive it.
std::function<double(const std::vector<std::string>&, double, double)> forces_of(const RobotReadings& robots, std::size_t number);

// Whether any of them asks what rays meet.
bool needs_rays(const std::vector<SensorItem>& sensors);

// Readings from start_ns until last_ns.
class ReadingSensor : public Sensor {
 public:
  ReadingSensor(const Scenario& scenario, int number, std::uint64_t noise_seed, std::int64_t start_ns, std::int64_t last_ns,
                std::shared_ptr<const MotionPath> path, std::shared_ptr<LidarWorld> world,
                std::function<double(const std::vector<std::string>&, double, double)> forces);

  std::optional<std::int64_t> next_stamp() const override;
  Sample take() override;

 private:
  SensorItem item_;
  int number_;
  std::int64_t start_ns_, last_ns_, next_ = 0;
  std::shared_ptr<const MotionPath> path_;
  std::shared_ptr<LidarWorld> world_;
  SensorSite site_;
  std::unique_ptr<SensorMeter> meter_;
};

}  // namespace rubble
