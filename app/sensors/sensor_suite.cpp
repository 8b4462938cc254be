#include "app/sensors/sensor_suite.h"

#include <algorithm>
#include <numeric>

#include "app/sensors/build_imu.h"
#include "app/sensors/lidar_sensor.h"
#include "app/sensors/reading_sensor.h"
#include "render/sensors/camera.h"
#include "scripting/trajectory/imu.h"
#include "scripting/trajectory/trajectory.h"

namespace rubble {
namespace {

CameraSpec spec_of(const Scenario& scenario, const MountedCamera& mounted, int number, const SensorBegin& begin,
                   int threads) {
  CameraSpec spec = build_camera(scenario, mounted, threads);
  spec.number = number;
  spec.seed = camera_seed(mounted, begin.noise_seed);
  return spec;
}

// A camera on its mount.
class CameraSensor : public Sensor {
 public:
  CameraSensor(const Scenario& scenario, const MountedCamera& mounted, int number,
               const RigFlight& flight, const SensorBegin& begin, Renderer& renderer, int threads)
      : flight_(flight.cameras[std::size_t(number)]),
        mounted_(mounted),
        number_(number),
        first_frame_(begin.frames.empty() ? 0 : begin.frames[std::size_t(number)]),
        start_ns_(flight.start_ns),
        path_(flight.carriers[std::size_t(number)]),
        camera_(renderer, spec_of(scenario, mounted, number, begin, threads), flight_) {}

  int frames() const { return camera_.frames(); }
  std::int64_t last_stamp() const { return flight_.stamps_ns.back(); }

  std::optional<std::int64_t> next_stamp() const override {
    if (next_ >= camera_.frames()) return std::nullopt;
    return flight_.stamps_ns[std::size_t(next_)];
  }

  Sample take() override {
    Frame frame = camera_.take(next_++);
    frame.sensor = number_;
    frame.starts_sequence = frame.index == 0;
    frame.index += first_frame_;
    const CameraMotion motion = path_->motion_at(double(frame.stamp_ns - start_ns_) * 1e-9);
    frame.rig_velocity = frame.linear_velocity = motion.velocity;
    if (mounted_.is_rig()) return frame;
    frame.world_from_rig = motion.world_from_camera;
    const Vec3 turning = cross(motion.angular_velocity, mounted_.position);
    frame.linear_velocity += motion.world_from_camera.rotation.rotate(turning);
    return frame;
  }

 private:
  Flight flight_;
  MountedCamera mounted_;
  int number_, first_frame_, next_ = 0;
  std::int64_t start_ns_;
  std::shared_ptr<const MotionPath> path_;
  Camera camera_;
};

// As long as any camera has frames.
class ImuSensor : public Sensor {
 public:
  ImuSensor(const ImuScenario& imu, int number, double gravity, std::uint64_t noise_seed, std::int64_t start_ns,
            std::int64_t last_ns, std::shared_ptr<const MotionPath> path)
      : number_(number),
        last_ns_(last_ns),
        path_(std::move(path)),
        imu_(build_imu(imu, gravity, noise_seed, start_ns, *path_)) {}

  std::optional<std::int64_t> next_stamp() const override {
    const std::int64_t stamp = imu_.next_stamp();
    return stamp <= last_ns_ ? std::optional(stamp) : std::nullopt;
  }
  Sample take() override {
    ImuSample sample = imu_.take();
    sample.sensor = number_;
    return sample;
  }

 private:
  int number_;
  std::int64_t last_ns_;
  std::shared_ptr<const MotionPath> path_;
  Imu imu_;
};

// What a robot sensed when it was driven, as long as any camera has frames.
class RobotSensor : public Sensor {
 public:
  RobotSensor(const std::vector<RobotSample>& samples, std::int64_t last_ns)
      : samples_(samples), last_ns_(last_ns) {}

  std::optional<std::int64_t> next_stamp() const override {
    if (next_ >= samples_.size() || samples_[next_].stamp_ns > last_ns_) return std::nullopt;
    return samples_[next_].stamp_ns;
  }
  Sample take() override { return samples_[next_++]; }

 private:
  const std::vector<RobotSample>& samples_;
  std::int64_t last_ns_;
  std::size_t next_ = 0;
};

}  // namespace

SensorSuite::SensorSuite(const Scenario& scenario, const RigFlight& flight, const SensorBegin& begin,
                         const Scene& scene, Renderer& renderer, int threads,
                         const RobotReadings& robots) {
  std::vector<std::unique_ptr<Sensor>> cameras;
  std::int64_t last_ns = 0;
  for (const MountedCamera& mounted : scenario.cameras) {
    auto camera = std::make_unique<CameraSensor>(scenario, mounted, int(cameras.size()), flight, begin,
                                                 renderer, threads);
    frames_.push_back(camera->frames());
    last_ns = std::max(last_ns, camera->last_stamp());
    cameras.push_back(std::move(camera));
  }
  for (const std::vector<RobotSample>& samples : robots.samples)
    sensors_.push_back(std::make_unique<RobotSensor>(samples, last_ns));
  int number = 0;
  for (const ImuScenario& imu : scenario.imus)
    sensors_.push_back(std::make_unique<ImuSensor>(imu, number++, scenario.settle.gravity, begin.noise_seed, flight.start_ns,
                                                   robots.end_of(imu.ride, flight.start_ns, last_ns),
                                                   robots.path_of(imu.ride, flight.path)));
  const auto world = scenario.lidars.empty() && !needs_rays(scenario.sensors) ? nullptr : std::make_shared<LidarWorld>(scene);
  for (auto& lidar : make_lidar_sensors(scenario.lidars, world, renderer.medium(), begin.noise_seed, flight.start_ns, last_ns,
                                        flight.path, robots, threads))
    sensors_.push_back(std::move(lidar));
  for (std::size_t i = 0; i < scenario.sensors.size(); ++i) {
    const Carrier& ride = scenario.sensors[i].ride;
    sensors_.push_back(std::make_unique<ReadingSensor>(scenario, int(i), begin.noise_seed, flight.start_ns, robots.end_of(ride, flight.start_ns, last_ns),
                                                       robots.path_of(ride, flight.path), world, forces_of(robots, i)));
  }
  for (auto& camera : cameras) sensors_.push_back(std::move(camera));
}

int SensorSuite::count_frames() const { return std::accumulate(frames_.begin(), frames_.end(), 0); }

std::optional<Sample> SensorSuite::take() {
  Sensor* first = nullptr;
  for (const auto& sensor : sensors_) {
    const auto stamp = sensor->next_stamp();
    if (stamp && (!first || *stamp < *first->next_stamp())) first = sensor.get();
  }
  if (!first) return std::nullopt;
  return first->take();
}

}  // namespace rubble
