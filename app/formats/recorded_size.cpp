#include "app/formats/recorded_size.h"

#include <algorithm>
#include <cmath>

#include "io/mrpt/simplemap_recorder.h"
#include "kernel/base/quick_math.h"
#include "scripting/trajectory/trajectory.h"

namespace rubble {
namespace {

constexpr double kUnknownFlight = 60;           // of a path into a void without `duration`; unit: s
constexpr double kDegrees = 57.29577951308232;  // of a radian

double angle_between(const Quat& a, const Quat& b) {
  return 2 * quick::acos(std::min(1.0, std::fabs((a.conjugate() * b).w)));
}

// A path into a void is known only when there is a pile.
bool leads_into_voids(const TrajectorySpec& path) {
  for (const Waypoint& w : path.waypoints)
    if (w.position_in_void || w.look_at_in_void) return true;
  return false;
}

// How long a pile takes to settle is known only afterwards.
constexpr double kUsualRest = 12;  // after the last layer; unit: s

// How long the camera watches the pile settle; unit: s.
double duration_of_settling(const Scenario& s) {
  const RecordSettlingScenario& asked = s.record_settling;
  const double last = std::max(0, s.pile.layers - 1) * s.settle.layer_time_limit + kUsualRest;
  return std::max(0.0, std::min(asked.to.value_or(last), last) - asked.from);
}

// Inertial units go on until the flight; unit: s.
double duration_until_flight(const Scenario& s) {
  Scenario whole = s;
  whole.record_settling.to.reset();
  return duration_of_settling(whole);
}

void count_scans(const Scenario& s, double duration, FlightSize& size) {
  for (const SensorItem& sensor : s.sensors) {
    if (!scans(sensor)) continue;
    const double count = std::floor(duration * sensor.rate()) + 1;
    size.scans += count;
    size.points += count * sensor.figures->most_points();
  }
}

double rate_of_readings(const Scenario& s) {
  double rate = 0;
  for (const SensorItem& sensor : s.sensors)
    if (!scans(sensor)) rate += sensor.rate();
  return rate;
}

// Of all together, and of the messages of other sensors, none of which is larger; unit: Hz
double rate_of_imus(const Scenario& s) {
  double rate = 0;
  for (const SensorItem& sensor : s.sensors)
    if (!scans(sensor)) rate += sensor.rate() * double(sensor.figures->topics().size());
  for (const ImuScenario& imu : s.imus) rate += imu.model.rate_hz;
  return rate;
}

double frames_of_settling(const Scenario& s, const MountedCamera& camera) {
  const double usual = s.record_settling.rate_hz.value_or(s.trajectory.rate_hz);
  return std::floor(duration_of_settling(s) * camera.rate_hz.value_or(usual)) + 1;
}

}  // namespace

FlightSize size_of_flight(const Scenario& s, std::size_t camera) {
  FlightSize size;
  const MountedCamera& mounted = s.cameras[camera];
  Scenario carried = s;
  if (mounted.ride.on()) carried.trajectory.ride.robot = mounted.ride.robot;
  TrajectorySpec path = flown_trajectory(carried);
  path.rate_hz = mounted.rate_hz.value_or(path.rate_hz);
  if (leads_into_voids(path)) {
    size.frames = std::floor(path.duration.value_or(kUnknownFlight) * path.rate_hz) + 1;
    size.key_frames = size.frames;
  } else {
    const SimplemapOptions key;
    const auto poses = sample_trajectory(path, s.start_ns);
    size.frames = double(poses.size());
    // The way of a robot is known only after its drive: every frame may be a key frame.
    size.key_frames = path.ride.on() ? size.frames : 1;
    for (std::size_t i = 1; i < poses.size() && !path.ride.on(); ++i) {
      const Pose &a = poses[i - 1].world_from_camera, &b = poses[i].world_from_camera;
      size.key_frames +=
          std::min(1.0, distance(a.translation, b.translation) / key.distance +
                            angle_between(a.rotation, b.rotation) * kDegrees / key.angle_deg);
    }
  }
  const double imu_rate = camera == 0 ? rate_of_imus(s) : 0;
  size.imu_samples = size.frames * imu_rate / path.rate_hz;
  if (camera == 0) size.readings = size.frames * rate_of_readings(s) / path.rate_hz;
  if (camera == 0) count_scans(s, size.frames / path.rate_hz, size);
  if (camera == 0) size.robot_samples = double(s.robots.size()) * (s.robot_run.duration * s.robot_run.control_hz + 2);
  if (!s.record_settling.on) return size;
  if (!mounted.ride.on()) size.frames += frames_of_settling(s, mounted);  // robots start when the pile rests
  if (camera == 0) count_scans(s, duration_of_settling(s), size);
  if (imu_rate > 0) size.imu_samples += duration_until_flight(s) * imu_rate + 1;
  return size;
}

std::vector<RecordedSize> sizes_of_recording(const Scenario& scenario, double pieces) {
  std::vector<RecordedSize> sizes;
  for (const MountedCamera& camera : scenario.cameras)
    sizes.push_back({camera, size_of_flight(scenario, sizes.size()),
                     PictureSize(camera, scenario.outputs.depth), 100 * pieces + 2e4});
  return sizes;
}

}  // namespace rubble
