// Samples of sensors, as plain data: a frame of a camera, a reading of an inertial unit.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "kernel/base/math.h"
#include "render/scene/image.h"

namespace rubble {

enum class LensModel {
  plumb_bob,  // pinhole with Brown-Conrady distortion: ROS plumb_bob, OpenCV calib3d
  fisheye,    // Kannala-Brandt: ROS equidistant, OpenCV cv::fisheye
};

// Pixel (0, 0) is at the top left; its centre has the coordinates (0, 0). Formulas: lens.h.
struct Intrinsics {
  int width = 1024, height = 1024;        // unit: pixel
  double fx = 0, fy = 0, cx = 0, cy = 0;  // unit: pixel
  // plumb_bob: k1 k2 p1 p2 k3, all 0 for a plain pinhole; fisheye: k1 k2 k3 k4 and 0.
  std::array<double, 5> distortion{};
  LensModel lens = LensModel::plumb_bob;  // meaning of the coefficients
};

// One change of brightness at one pixel of an event camera.
struct Event {
  std::int64_t stamp_ns = 0;   // simulation time; unit: ns
  std::uint16_t x = 0, y = 0;  // column and row; unit: pixel
  bool brighter = false;       // sign of the change
};

// A reading of an inertial unit.
struct ImuSample {
  std::int64_t stamp_ns = 0;  // simulation time; unit: ns
  int sensor = 0;             // number among the recording's inertial units
  Vec3 angular_velocity;      // in the frame of the unit; unit: rad/s
  Vec3 linear_acceleration;   // specific force: at rest and level (0, 0, 9.81); unit: m/s2
  Vec3 angular_bias;          // true offset of the angular velocity; unit: rad/s
  Vec3 acceleration_bias;     // true offset of the acceleration; unit: m/s2
};

// White noise and random walk of the biases, as in the calibration of an inertial unit (continuous-time densities, as
// in Kalibr and EuRoC's sensor.yaml). The defaults are those of EuRoC's ADIS16448.
struct ImuModel {
  double rate_hz = 200;                    // of readings; unit: Hz
  double gyroscope_noise = 1.6968e-4;      // unit: rad/s/sqrt(Hz)
  double gyroscope_walk = 1.9393e-5;       // unit: rad/s2/sqrt(Hz)
  double accelerometer_noise = 2.0000e-3;  // unit: m/s2/sqrt(Hz)
  double accelerometer_walk = 3.0000e-3;   // unit: m/s3/sqrt(Hz)
};

struct Frame {
  int sensor = 0;                 // number among the recording's cameras
  int index = 0;                  // of this camera, 0-based
  bool starts_sequence = false;   // it may follow a pause of any length, or another rate
  std::int64_t stamp_ns = 0;      // simulation time of the whole frame; unit: ns
  Intrinsics intrinsics;          // of colour and depth, which are registered
  Pose world_from_camera;         // camera body frame: X forward, Y left, Z up
  Vec3 linear_velocity;           // of the camera, in the world; unit: m/s
  Pose world_from_rig;            // of the carrier: the rig (X forward, Y left, Z up), or a robot's link;
  Vec3 rig_velocity;              // its velocity, in the world; unit: m/s. Of the camera of a mission
                                  // that has one camera, both are those of the camera
  std::vector<std::uint8_t> rgb;  // 3 bytes a pixel, rows from the top
  std::vector<float> depth;       // planar, along the optical axis; unit: m; NaN: no return

  // Optional parts; empty if the mission does not request them. Rows from the top, as rgb and depth.
  std::vector<std::uint8_t> rgb_right;  // the right camera of a stereo pair, 3 bytes a pixel
  double baseline = 0;                  // distance of the right camera along -Y of the body, with the same
                                        // orientation and intrinsics; unit: m; 0: no right camera
  std::vector<float> measured_depth;    // as depth, from the model of the depth sensor
  // Images of ground truth by the names of their streams; contents: render/streams/.
  std::map<std::string, ImageValues, std::less<>> truth;
  std::vector<Event> events;            // since the previous frame, in order of stamp, row, column
  double exposure_s = 0;                // exposure time; 0: not modelled
  // Of each row of pixels, world from optical frame, by which its depth counts: of a rolling shutter. Empty: all as world_from_camera,
  // or a recording does not have them.
  std::vector<Pose> row_poses;

  Pose world_from_optical(int row) const {
    return row_poses.empty() ? world_from_camera * camera_from_optical : row_poses[std::size_t(row)];
  }

  // The values of a stream of ground truth; empty if the frame has none.
  template <typename T>
  const std::vector<T>& get(std::string_view stream) const {
    static const std::vector<T> none;
    const auto at = truth.find(stream);
    return at == truth.end() ? none : std::get<std::vector<T>>(at->second);
  }
};

// Values of the stream `instance` without a piece.
inline constexpr std::uint32_t kNoInstance = 0xfffffffeu;
inline constexpr std::uint32_t kGroundInstance = 0xffffffffu;
// Values of the stream `label`.
inline constexpr std::uint16_t kSkyLabel = 0, kGroundLabel = 1, kFirstAssetLabel = 2;

}  // namespace rubble
