// Cameras and inertial units of a mission as plain data. camera_schema.cpp lists the keys of cameras.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kernel/base/math.h"
#include "render/scene/camera_spec.h"
#include "render/scene/frame.h"
#include "scripting/trajectory/trajectory.h"

namespace rubble {

enum class LensKind { pinhole, plumb_bob, fisheye };

// Formulas: render/camera/lens.h.
struct LensScenario {
  LensKind model = LensKind::pinhole;  // how pixels see; the coefficients that it uses are below
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0;  // plumb_bob; k1 to k3 of a fisheye, too
  double k4 = 0;                                  // of a fisheye
  // Of a calibrated camera; not given: from the field of view, and the middle. unit: pixel
  std::optional<double> fx{}, fy{}, cx{}, cy{};
};

struct CameraScenario {
  int width = 1024, height = 1024;  // unit: pixel; range: 16 to 8192
  // Horizontal, from edge to edge of the image; range: 1 to 170, of a fisheye to 360.
  double fov_deg = 90;
  // Ground truth beside colour and depth, of channel_names().
  std::vector<std::string> channels{};
  ColourSpec colour{};         // fast, or path traced; the same for all cameras of a mission
  LensScenario lens{};         // calibration; without one a pinhole of fov_deg
  double stereo_baseline = 0;  // to the right camera of a pair; 0: none; unit: m; range: 0 to 10
  ShutterSpec shutter{};       // when each row is exposed
  ExposureSpec exposure{};     // how bright the image is
  OpticsSpec optics{};         // what the lens does to the light
  ImageSensorSpec sensor{};    // noise, converter, response
  std::optional<std::string> topic{};     // ROS: what its topics begin with; not given: "/NAME"
  std::optional<std::string> frame_id{};  // TF: of its pictures (Z forward); not given: "NAME_optical_frame"

  // fx = fy = (width / 2) / r(fov / 2), where r is tan for a pinhole and for plumb_bob, whose
  // distortion is left out of account, and the lens's own curve for a fisheye; the principal point is
  // the middle of the image, (width - 1) / 2 where pixel (0, 0) has its centre at (0, 0). What the
  // lens states itself comes first.
  Intrinsics intrinsics() const;
  // The streams that `channels` names, in the order of the table; unknown names are left out.
  StreamSet channel_set() const;
  bool has_channel(const std::string& name) const;  // whether `channels` names it
};

// A camera on the rig that flies the trajectory, or on a link of a robot.
struct MountedCamera {
  std::string name = "camera";  // lower-case letters, digits and underscores
  // One of the table `cameras`; false: the `camera` of a mission, which is the rig itself, and whose name is in no file.
  bool named = false;
  Carrier ride{};               // what carries it instead of the rig
  Vec3 position;                // of its body in the rig (X forward, Y left, Z up), or the link; unit: m
  Vec3 rpy_deg;                 // of its body, likewise; unit: degree
  std::optional<double> rate_hz{};    // frames per second; not given: trajectory.rate_hz
  CameraScenario camera{};            // image, lens, channels
  DepthSensorSpec depth_sensor{};     // in its place
  EventCameraSpec event_camera{};     // in its place

  std::string key() const { return named ? "cameras." + name : name; }  // in the mission
  // Of files that hold one camera, where `run` is that of the run.
  std::string folder_in(const std::string& run) const { return named ? run + "/cameras/" + name : run; }
  std::string topic() const { return camera.topic.value_or("/" + name); }
  std::string frame_id() const { return camera.frame_id.value_or(name + "_optical_frame"); }
  bool is_rig() const { return position == Vec3() && rpy_deg == Vec3(); }
  Pose rig_from_camera() const;
};

// What CameraScenario::channels may name.
std::vector<std::string> channel_names();

// An inertial unit on the rig, or on a link of a robot.
struct ImuScenario {
  std::string name = "imu";
  bool named = false;  // one of the table `imus`; false: the `imu` of a mission
  Carrier ride{};      // what carries it instead of the rig
  ImuModel model;   // rate, noise and biases
  Vec3 position;    // in the rig or the link (X forward, Y left, Z up); unit: m; range: -10 to 10
  Vec3 rpy_deg;     // of its axes, likewise; unit: degree
  std::optional<std::string> topic{};     // ROS; not given: "/NAME"
  std::optional<std::string> frame_id{};  // TF; not given: the carrier's where it is there, else "NAME_link"

  std::string key() const { return named ? "imus." + name : name; }  // in the mission
  std::string ros_topic() const { return topic.value_or("/" + name); }
  bool is_rig() const { return position == Vec3() && rpy_deg == Vec3(); }
  Pose rig_from_imu() const;
};

}  // namespace rubble
