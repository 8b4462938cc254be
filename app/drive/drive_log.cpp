#include "app/drive/drive_log.h"

#include <algorithm>
#include <cmath>

#include "app/mission/scenario_lua.h"
#include "render/streams/image_streams.h"

namespace rubble {

std::vector<std::string> adapt_to_driving(Scenario& scenario) {
  std::vector<std::string> off;
  const auto turn_off = [&off](bool on, const std::string& what) {
    if (on) off.push_back(what);
    return on;
  };
  MountedCamera& mounted = scenario.cameras.front();
  CameraScenario& camera = mounted.camera;
  if (turn_off(camera.shutter.readout > 0, "rolling shutter")) camera.shutter.readout = 0;
  if (turn_off(camera.shutter.motion_blur, "motion blur")) camera.shutter.motion_blur = false;
  std::vector<std::string>& channels = camera.channels;
  for (const ImageStream* stream : truth_streams()) {
    const auto at = std::find(channels.begin(), channels.end(), stream->name);
    if (turn_off(at != channels.end() && stream->needs_next, stream->name)) channels.erase(at);
  }
  if (turn_off(mounted.event_camera.on, "event camera")) mounted.event_camera.on = false;
  // Robots carry theirs, along a way that a run goes again.
  if (scenario.robots.empty()) {
    if (turn_off(!scenario.imus.empty(), "inertial units")) scenario.imus.clear();
    if (turn_off(!scenario.sensors.empty(), "other sensors")) scenario.sensors.clear();
  }
  scenario.outputs.pcd = scenario.outputs.kitti = false;
  TrajectorySpec& spec = scenario.trajectory;
  spec.limits = {};
  spec.duration.reset();
  spec.interpolation = Interpolation::linear;
  // A run walks the path again and says so if the body touches anything.
  if (spec.plan == Plan::avoid) spec.plan = Plan::refuse;
  return off;
}

DriveLog::DriveLog(const Scenario& scenario, int steps_per_frame) : scenario_(scenario), steps_per_frame_(steps_per_frame) {}

void DriveLog::add(const DrivenPose& pose) { poses_.push_back(pose); }

// Where there is a frame, to the bit that of the frame.
double DriveLog::time(int step) const {
  const double within = double(step % steps_per_frame_) / steps_per_frame_;
  return (double(step / steps_per_frame_) + within) / scenario_.trajectory.rate_hz;
}

// As sample_trajectory() has it.
std::int64_t DriveLog::stamp_ns(int frame) const {
  const double rate = scenario_.trajectory.rate_hz;
  return scenario_.start_ns + static_cast<std::int64_t>(std::floor(double(frame) * 1e9 / rate + 0.5));
}

// That of the leg in which the frame's stamp lies: rounded to nanoseconds, it may be just before the
// waypoint's time. After the last pose the camera stands still.
Vec3 DriveLog::velocity(int frame) const {
  const double t = double(stamp_ns(frame) - scenario_.start_ns) * 1e-9;
  const int step = frame * steps_per_frame_, leg = t < time(step) ? step - 1 : step;
  if (leg + 1 >= steps()) return {};
  const Vec3 way = poses_[std::size_t(leg) + 1].position - poses_[std::size_t(leg)].position;
  return way * (1.0 / (time(leg + 1) - time(leg)));
}

// A last waypoint a little after the last step: what comes after a step is a leg on which the
// camera stands, so that a last frame, too, is exactly at its waypoint.
Scenario DriveLog::scenario() const {
  Scenario whole = scenario_;
  std::vector<Waypoint>& waypoints = whole.trajectory.waypoints;
  waypoints.clear();
  for (int k = 0; k <= steps() && steps() > 0; ++k) {
    const DrivenPose& pose = poses_[std::size_t(std::min(k, steps() - 1))];
    Waypoint w;
    w.t = k < steps() ? time(k) : (double(k) - 0.99) / (whole.trajectory.rate_hz * steps_per_frame_);
    w.position = pose.position;
    w.rpy_deg = pose.rpy_deg;
    waypoints.push_back(w);
  }
  return whole;
}

std::string DriveLog::mission(const std::string& comment) const {
  return scenario_to_lua(scenario(), comment);
}

}  // namespace rubble
