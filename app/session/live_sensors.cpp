#include "app/session/live_sensors.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/sensors/build_camera.h"
#include "app/sensors/build_imu.h"
#include "app/sensors/exact_depth.h"
#include "app/sensors/reading_sensor.h"
#include "kernel/base/error.h"
#include "kernel/base/random.h"
#include "render/lidar/lidar.h"

namespace rubble {
namespace {

class LiveImu : public LiveSensor {
 public:
  LiveImu(const Scenario& scenario, const ImuScenario& imu, int number, std::shared_ptr<const MotionPath> way)
      : way_(std::move(way)),
        number_(number),
        half_ns_(std::int64_t(std::ceil(0.5e9 / imu.model.rate_hz))),
        imu_(build_imu(imu, scenario.settle.gravity, scenario.seed, scenario.start_ns, *way_)) {}

  Needs needs() const override {
    const std::int64_t stamp = imu_.next_stamp();
    return {stamp - half_ns_, stamp + half_ns_, INT64_MIN};
  }
  Sample take() override {
    ImuSample sample = imu_.take();
    sample.sensor = number_;
    return sample;
  }

 private:
  std::shared_ptr<const MotionPath> way_;
  int number_;
  std::int64_t half_ns_;  // of its period
  Imu imu_;
};

class LiveLidar : public LiveSensor {
 public:
  LiveLidar(const LiveSensorParts& parts, int number, std::shared_ptr<const MotionPath> way)
      : number_(number), lidar_(make(parts, parts.scenario.lidars[std::size_t(number)], std::move(way))) {}

  Needs needs() const override {
    const std::int64_t end = lidar_.stamp_ns(next_ + 1);
    return {lidar_.stamp_ns(next_), end, end + Lidar::kSceneStep};
  }
  Sample take() override {
    LidarScan scan = lidar_.take(next_++);
    scan.sensor = number_;
    return scan;
  }

 private:
  // As the sensor that records: the same noise.
  static Lidar make(const LiveSensorParts& parts, const LidarScenario& lidar, std::shared_ptr<const MotionPath> way) {
    const std::int64_t start = parts.scenario.start_ns;
    const auto place = [way = std::move(way), carrier_from_lidar = lidar.rig_from_lidar(), start](std::int64_t stamp_ns) {
      return way->at(double(stamp_ns - start) * 1e-9) * carrier_from_lidar;
    };
    const std::uint64_t seed = RandomStream(parts.scenario.seed, "lidars/" + lidar.name).next();
    return {lidar.spec(), parts.world, {place, start}, parts.medium, seed, parts.threads};
  }

  int number_, next_ = 0;
  Lidar lidar_;
};

class LiveReading : public LiveSensor {
 public:
  LiveReading(const LiveSensorParts& parts, std::size_t number, std::shared_ptr<const MotionPath> way)
      : item_(parts.scenario.sensors[number]),
        number_(int(number)),
        start_ns_(parts.scenario.start_ns),
        way_(std::move(way)),
        world_(parts.world),
        site_(make_sensor_site(parts.scenario, parts.scenario.start_ns, item_, *way_, world_.get(), forces_of(parts.history.ways(), number))),
        meter_(item_.start(site_, parts.scenario.seed)) {}

  Needs needs() const override {
    const std::int64_t stamp = item_.stamp_ns(next_, start_ns_);
    return {stamp - kRounding, stamp + kRounding, item_.figures->casts_rays() ? stamp + kRounding : INT64_MIN};
  }
  Sample take() override {
    const std::int64_t stamp = item_.stamp_ns(next_, start_ns_);
    return Reading{number_, stamp, meter_->read(double(next_++) / item_.rate_hz)};
  }

 private:
  static constexpr std::int64_t kRounding = 1000;  // of stamps; unit: ns

  SensorItem item_;
  int number_;
  std::int64_t start_ns_, next_ = 0;
  std::shared_ptr<const MotionPath> way_;
  std::shared_ptr<LidarWorld> world_;
  SensorSite site_;
  std::unique_ptr<SensorMeter> meter_;
};

class LiveDepth : public LiveSensor {
 public:
  LiveDepth(const LiveSensorParts& parts, const MountedCamera& camera, int number, std::shared_ptr<const MotionPath> way)
      : camera_(camera),
        number_(number),
        start_ns_(parts.scenario.start_ns),
        rate_hz_(camera.rate_hz.value_or(parts.scenario.trajectory.rate_hz)),
        way_(std::move(way)),
        depth_(camera, parts.world, parts.threads) {}

  Needs needs() const override { return {stamp_ns(), stamp_ns(), stamp_ns()}; }
  Sample take() override {
    Frame frame;
    frame.sensor = number_, frame.index = next_, frame.stamp_ns = stamp_ns();
    frame.intrinsics = depth_.intrinsics();
    // At the time of the frame, which its stamp rounds.
    frame.world_from_rig = way_->at(double(next_++) / rate_hz_);
    frame.world_from_camera = place_on_mount(camera_, frame.world_from_rig);
    frame.depth = depth_.measure(frame.stamp_ns, frame.world_from_camera);
    return frame;
  }

 private:
  std::int64_t stamp_ns() const { return start_ns_ + std::int64_t(std::floor(double(next_) * 1e9 / rate_hz_ + 0.5)); }

  MountedCamera camera_;
  int number_, next_ = 0;
  std::int64_t start_ns_;
  double rate_hz_;
  std::shared_ptr<const MotionPath> way_;
  ExactDepth depth_;
};

}  // namespace

std::unique_ptr<LiveSensor> make_live_imu(const LiveSensorParts& parts, std::size_t number) {
  const ImuScenario& imu = parts.scenario.imus.at(number);
  return std::make_unique<LiveImu>(parts.scenario, imu, int(number), parts.history.way_of(imu.ride, imu.key()));
}

std::unique_ptr<LiveSensor> make_live_reading(const LiveSensorParts& parts, std::size_t number) {
  const SensorItem& sensor = parts.scenario.sensors.at(number);
  return std::make_unique<LiveReading>(parts, number, parts.history.way_of(sensor.ride, sensor.key()));
}

std::unique_ptr<LiveSensor> make_live_lidar(const LiveSensorParts& parts, std::size_t number) {
  const LidarScenario& lidar = parts.scenario.lidars.at(number);
  return std::make_unique<LiveLidar>(parts, int(number), parts.history.way_of(lidar.ride, "lidars." + lidar.name));
}

std::unique_ptr<LiveSensor> make_live_depth(const LiveSensorParts& parts, std::size_t number) {
  const MountedCamera& camera = parts.scenario.cameras.at(number);
  return std::make_unique<LiveDepth>(parts, camera, int(number), parts.history.way_of(camera.ride, camera.key()));
}

}  // namespace rubble
