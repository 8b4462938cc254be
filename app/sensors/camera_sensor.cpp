#include "app/sensors/camera_sensor.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/sensors/camera_renderers.h"
#include "render/sensors/camera.h"

namespace rubble {
namespace {

CameraSpec build_spec(const SensorParts& parts, const MountedCamera& mounted, std::size_t number) {
  CameraSpec spec = build_camera(mounted, parts.scenario.seed, parts.threads);
  spec.number = int(number);
  spec.seed = camera_seed(mounted, parts.noise_seed);
  return spec;
}

// From the start of an exposure to its stamp, and from there to its end, at most.
std::int64_t half_exposure_ns(const CameraSpec& spec) {
  const double longest = std::max(spec.exposure.time, spec.exposure.longest_time);
  const bool modelled = spec.exposure.mode != ExposureMode::ideal;
  return std::int64_t(std::ceil(0.5e9 * ((modelled ? longest : 0) + spec.shutter.readout)));
}

class FlownCamera : public Sensor {
 public:
  FlownCamera(const SensorParts& parts, const MountedCamera& mounted, const CameraSpec& spec, const Flight& flight,
              std::shared_ptr<const MotionPath> way, int first_frame, Renderer& renderer)
      : mounted_(mounted), stamps_(flight.stamps_ns), number_(spec.number), first_frame_(first_frame),
        start_ns_(parts.start_ns), way_(std::move(way)), camera_(renderer, spec, flight) {}

  Needs needs() const override {
    const std::int64_t stamp = std::size_t(next_) < stamps_.size() ? stamps_[std::size_t(next_)] : INT64_MAX;
    return {stamp, stamp, stamp, stamp, stamp};
  }
  Sample take() override {
    Frame frame = camera_.take(next_++);
    frame.sensor = number_;
    frame.starts_sequence = frame.index == 0;
    frame.index += first_frame_;
    const CameraMotion motion = way_->motion_at(double(frame.stamp_ns - start_ns_) * 1e-9);
    frame.rig_velocity = frame.linear_velocity = motion.velocity;
    if (mounted_.is_rig()) return frame;
    frame.world_from_rig = motion.world_from_camera;
    const Vec3 turning = cross(motion.angular_velocity, mounted_.position);
    frame.linear_velocity += motion.world_from_camera.rotation.rotate(turning);
    return frame;
  }

 private:
  MountedCamera mounted_;
  std::vector<std::int64_t> stamps_;
  int number_, first_frame_, next_ = 0;
  std::int64_t start_ns_;
  std::shared_ptr<const MotionPath> way_;
  Camera camera_;
};

// Of cameras that ride: when, and where.
class RidingSensor : public Sensor {
 public:
  RidingSensor(const SensorParts& parts, const MountedCamera& mounted, std::size_t number, std::int64_t half_ns)
      : mounted_(mounted), number_(int(number)), start_ns_(parts.start_ns), half_ns_(half_ns),
        rate_hz_(mounted.rate_hz.value_or(parts.scenario.trajectory.rate_hz)),
        way_(parts.way_of(mounted.ride, mounted.key())) {}

  Needs needs() const override {
    const std::int64_t stamp = stamp_ns();
    return {stamp, stamp, stamp - half_ns_, stamp + half_ns_, stamp + half_ns_};
  }

 protected:
  std::int64_t stamp_ns() const { return start_ns_ + std::int64_t(std::floor(double(next_) * 1e9 / rate_hz_ + 0.5)); }
  // Of its carrier, at the time of the frame, which its stamp rounds.
  Pose carrier() const { return way_->at(double(next_) / rate_hz_); }
  Flight fly() const {
    Flight flight;
    flight.pose_at = [way = way_, mounted = mounted_, start = start_ns_](std::int64_t stamp_ns) {
      return place_on_mount(mounted, way->at(double(stamp_ns - start) * 1e-9));
    };
    return flight;
  }

  MountedCamera mounted_;
  int number_, next_ = 0;

 private:
  std::int64_t start_ns_, half_ns_;
  double rate_hz_;
  std::shared_ptr<const MotionPath> way_;
};

class RidingCamera : public RidingSensor {
 public:
  RidingCamera(const SensorParts& parts, const MountedCamera& mounted, const CameraSpec& spec, Renderer& renderer)
      : RidingSensor(parts, mounted, std::size_t(spec.number), half_exposure_ns(spec)), camera_(renderer, spec, fly()) {}

  Sample take() override {
    const Pose world_from_rig = carrier();
    camera_.fly_on(stamp_ns(), place_on_mount(mounted_, world_from_rig));
    Frame drawn = camera_.take(next_++);
    drawn.sensor = number_;
    drawn.world_from_rig = world_from_rig;
    drawn.depth.clear();
    return drawn;
  }

 private:
  Camera camera_;
};

class DepthSensorByRays : public RidingSensor {
 public:
  DepthSensorByRays(const SensorParts& parts, const MountedCamera& camera, std::size_t number)
      : RidingSensor(parts, camera, number, 0), depth_(camera, parts.rays, parts.threads) {}

  Sample take() override {
    Frame frame;
    frame.sensor = number_, frame.index = next_, frame.stamp_ns = stamp_ns();
    frame.intrinsics = depth_.intrinsics();
    frame.world_from_rig = carrier();
    frame.world_from_camera = place_on_mount(mounted_, frame.world_from_rig);
    frame.depth = depth_.measure(frame.stamp_ns, frame.world_from_camera);
    ++next_;
    return frame;
  }

 private:
  ExactDepth depth_;
};

}  // namespace

std::unique_ptr<Sensor> make_flown_camera(const SensorParts& parts, std::size_t number, const RigFlight& flight, int first_frame,
                                          Renderer& renderer) {
  const MountedCamera& mounted = parts.scenario.cameras.at(number);
  return std::make_unique<FlownCamera>(parts, mounted, build_spec(parts, mounted, number), flight.cameras[number],
                                       flight.carriers[number], first_frame, renderer);
}

// What is developed is what the recorded camera gives, and nothing besides.
std::unique_ptr<Sensor> make_riding_camera(const SensorParts& parts, std::size_t number, Renderer& renderer) {
  const MountedCamera& mounted = parts.scenario.cameras.at(number);
  CameraSpec spec = build_spec(parts, mounted, number);
  spec.channels.clear();
  spec.baseline = 0;
  spec.depth_sensor.type = DepthSensorType::none;
  spec.event_camera.on = false;
  return std::make_unique<RidingCamera>(parts, mounted, spec, renderer);
}

std::unique_ptr<Sensor> make_depth_sensor(const SensorParts& parts, std::size_t number) {
  return std::make_unique<DepthSensorByRays>(parts, parts.scenario.cameras.at(number), number);
}

}  // namespace rubble
