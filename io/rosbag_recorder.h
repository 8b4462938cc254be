// A ROS 1 bag (format 2.0) of colour, registered depth, intrinsics, the true pose, transforms and
// the clock.
//
//   /camera/rgb/image_raw, /camera/rgb/camera_info                rgb8
//   /camera/depth_registered/image_raw (16UC1, mm, 0: no return)
//     or /camera/depth_registered/image (32FC1, m, NaN: no return), and .../camera_info
//   /ground_truth/pose    the camera body in `world`
//   /tf                   world -> camera_link
//   /tf_static            camera_link -> camera_optical_frame, latched
//   /clock
// Pictures are in camera_optical_frame. All that belongs to a frame bears its one stamp.
#pragma once

#include <memory>
#include <string>

#include "io/recorder.h"

namespace rubble {

enum class BagDepth {
  millimetres,  // 16UC1: a third smaller, up to 65.535 m
  metres,       // 32FC1: exactly what was rendered
};

struct RosbagOptions {
  BagDepth depth = BagDepth::millimetres;
  bool compress = true;  // LZ4
};

// Stamps must be later than 0. Throws RunError when `path` cannot be created.
std::unique_ptr<Recorder> make_rosbag_recorder(const std::string& path,
                                               const RosbagOptions& options = {});

}  // namespace rubble
