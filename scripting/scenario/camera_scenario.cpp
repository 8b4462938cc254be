#include "scripting/scenario/camera_scenario.h"

#include <algorithm>

#include "kernel/base/portable_math.h"
#include "render/streams/image_streams.h"
#include "scripting/scenario/scenario.h"

namespace rubble {
namespace {

Pose pose_of(const Vec3& position, const Vec3& rpy_deg) {
  constexpr double kRadians = portable::kPi / 180;
  return {portable::quat_from_rpy(rpy_deg.x * kRadians, rpy_deg.y * kRadians, rpy_deg.z * kRadians),
          position};
}

}  // namespace

std::vector<std::string> channel_names() {
  std::vector<std::string> names;
  for (const ImageStream* stream : truth_streams()) names.push_back(stream->name);
  return names;
}

StreamSet CameraScenario::channel_set() const {
  StreamSet set;
  for (const ImageStream* stream : truth_streams())
    if (has_channel(stream->name)) set.push_back(stream);
  return set;
}

bool CameraScenario::has_channel(const std::string& name) const {
  return std::find(channels.begin(), channels.end(), name) != channels.end();
}

Pose MountedCamera::rig_from_camera() const { return pose_of(position, rpy_deg); }
Pose ImuScenario::rig_from_imu() const { return pose_of(position, rpy_deg); }

bool has_channel(const Scenario& scenario, const std::string& name) {
  return std::any_of(scenario.cameras.begin(), scenario.cameras.end(),
                     [&](const MountedCamera& c) { return c.camera.has_channel(name); });
}

Intrinsics CameraScenario::intrinsics() const {
  const double angle = fov_deg * (portable::kPi / 360.0);
  Intrinsics in;
  in.width = width;
  in.height = height;
  double half = 0;  // from the axis to the edge, at a focal length of 1
  if (lens.model == LensKind::fisheye) {
    in.lens = LensModel::fisheye;
    in.distortion = {lens.k1, lens.k2, lens.k3, lens.k4, 0};
    const double a2 = angle * angle;
    half = angle * (1 + a2 * (lens.k1 + a2 * (lens.k2 + a2 * (lens.k3 + a2 * lens.k4))));
    in.fx = in.fy = 0.5 * width / half;
  } else {
    const portable::SinCos edge = portable::sincos(angle);
    in.fx = in.fy = 0.5 * width * edge.cos / edge.sin;
    if (lens.model == LensKind::plumb_bob)
      in.distortion = {lens.k1, lens.k2, lens.p1, lens.p2, lens.k3};
  }
  in.fx = lens.fx.value_or(in.fx);
  in.fy = lens.fy.value_or(lens.fx.value_or(in.fy));
  in.cx = lens.cx.value_or(0.5 * (width - 1));
  in.cy = lens.cy.value_or(0.5 * (height - 1));
  return in;
}

}  // namespace rubble
