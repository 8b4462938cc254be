#include "app/sensors/build_camera.h"

#include <utility>

#include "kernel/base/random.h"
#include "scripting/trajectory/trajectory.h"

namespace rubble {

CameraSpec build_camera(const MountedCamera& mounted, std::uint64_t seed, int threads) {
  const CameraScenario& camera = mounted.camera;
  CameraSpec spec;
  spec.intrinsics = camera.intrinsics();
  spec.channels = camera.channel_set();
  spec.baseline = camera.stereo_baseline;
  spec.shutter = camera.shutter;
  spec.exposure = camera.exposure;
  spec.optics = camera.optics;
  spec.sensor = camera.sensor;
  spec.depth_sensor = mounted.depth_sensor;
  spec.event_camera = mounted.event_camera;
  spec.seed = seed;
  // On a link, each camera bears a lamp of its own.
  if (!mounted.is_rig() && !mounted.ride.on()) spec.rig_from_camera = mounted.rig_from_camera();
  spec.threads = threads;
  return spec;
}

std::uint64_t camera_seed(const MountedCamera& camera, std::uint64_t noise_seed) {
  return camera.named ? RandomStream(noise_seed, "cameras/" + camera.name).next() : noise_seed;
}

// The same bits where the camera is the rig.
Pose place_on_mount(const MountedCamera& camera, const Pose& carrier) {
  return camera.is_rig() ? carrier : carrier * camera.rig_from_camera();
}

Flight build_flight(const MountedCamera& camera, std::int64_t start_ns, double rate_hz,
                    std::shared_ptr<const MotionPath> path) {
  Flight flight;
  for (const CameraPose& pose : sample_path(*path, camera.rate_hz.value_or(rate_hz), start_ns)) {
    flight.stamps_ns.push_back(pose.stamp_ns);
    flight.world_from_camera.push_back(place_on_mount(camera, pose.world_from_camera));
  }
  flight.pose_at = [path = std::move(path), camera, start = start_ns](std::int64_t stamp_ns) {
    return place_on_mount(camera, path->at(double(stamp_ns - start) * 1e-9));
  };
  return flight;
}

RigFlight build_rig_flight(const std::vector<MountedCamera>& cameras, std::int64_t start_ns, double rate_hz,
                           std::shared_ptr<const MotionPath> path, const RobotReadings& robots) {
  RigFlight flight;
  flight.start_ns = start_ns;
  for (const MountedCamera& camera : cameras) {
    flight.carriers.push_back(robots.path_of(camera.ride, path));
    const auto& carrier = flight.carriers.back();
    flight.cameras.push_back(carrier ? build_flight(camera, start_ns, rate_hz, carrier) : Flight{});
  }
  flight.path = std::move(path);
  return flight;
}

}  // namespace rubble
