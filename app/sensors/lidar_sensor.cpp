#include "app/sensors/lidar_sensor.h"

#include "kernel/base/random.h"
#include "render/lidar/lidar.h"

namespace rubble {
namespace {

constexpr std::int64_t kRounding = 1000;  // of stamps; unit: ns

// Whole scans, as other streams end with the last frame; where none fits, one all the same.
class LidarSensor : public Sensor {
 public:
  LidarSensor(std::unique_ptr<Lidar> lidar, int number, std::int64_t last_ns)
      : lidar_(std::move(lidar)), number_(number), last_ns_(last_ns) {}

  std::optional<std::int64_t> next_stamp() const override {
    const std::int64_t stamp = lidar_->stamp_ns(next_), end = lidar_->stamp_ns(next_ + 1);
    return end <= last_ns_ + kRounding || (next_ == 0 && stamp <= last_ns_) ? std::optional(stamp) : std::nullopt;
  }
  Sample take() override {
    LidarScan scan = lidar_->take(next_++);
    scan.sensor = number_;
    return scan;
  }

 private:
  std::unique_ptr<Lidar> lidar_;
  int number_, next_ = 0;
  std::int64_t last_ns_;
};

LidarPlace place_of(const LidarScenario& lidar, std::int64_t start, std::shared_ptr<const MotionPath> path) {
  const Pose rig_from_lidar = lidar.rig_from_lidar();
  return {[path = std::move(path), rig_from_lidar, start](std::int64_t stamp_ns) {
            return path->at(double(stamp_ns - start) * 1e-9) * rig_from_lidar;
          },
          start};
}

}  // namespace

std::vector<std::unique_ptr<Sensor>> make_lidar_sensors(const std::vector<LidarScenario>& lidars,
                                                        const std::shared_ptr<LidarWorld>& world, const Medium& medium,
                                                        std::uint64_t noise_seed, std::int64_t start_ns, std::int64_t last_ns,
                                                        std::shared_ptr<const MotionPath> path,
                                                        const RobotReadings& robots, int threads) {
  std::vector<std::unique_ptr<Sensor>> sensors;
  for (const LidarScenario& lidar : lidars) {
    const std::uint64_t seed = RandomStream(noise_seed, "lidars/" + lidar.name).next();
    sensors.push_back(std::make_unique<LidarSensor>(
        std::make_unique<Lidar>(lidar.spec(), world, place_of(lidar, start_ns, robots.path_of(lidar.ride, path)), medium, seed, threads),
        int(sensors.size()), robots.end_of(lidar.ride, start_ns, last_ns)));
  }
  return sensors;
}

}  // namespace rubble
