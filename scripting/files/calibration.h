// Calibrations of real sensors, as keys of a mission.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scripting/values/value.h"

namespace rubble {

struct SensorCalibration {
  std::string format;  // "Kalibr camchain", "OpenCV", "ROS camera_info", "ORB-SLAM settings", "Ouster metadata"
  // "camera": the keys of a `camera`; of a chain of several, "cameras": by their names, with position and
  // rpy_deg in the rig, whose origin is the first camera. Of Ouster metadata the keys of its kind.
  Value keys;
  std::vector<std::string> notes;  // what is left out
};

// Reads YAML or JSON of
//   Kalibr (camchain): pinhole with radtan, equidistant or none; also as OpenVINS has it
//   OpenCV (FileStorage): camera_matrix, distortion_coefficients, image_width, image_height; and the names
//     that other programs write there: cameraMatrix, K, M1, D, distCoeffs, image_size
//   ROS camera_info: the same with distortion_model plumb_bob or equidistant, or width, height, K, D as
//     `rostopic echo` prints them
//   ORB-SLAM2 and 3: Camera.fx or Camera1.fx, ...
//   Ouster sensors' metadata, old and new: product, mode
// Throws InputError with `path` and the key: a model of lenses that is not simulated, by its name; a
// size, matrix or mode that is missing or has another form.
SensorCalibration parse_calibration(std::string_view text, const std::string& path);

}  // namespace rubble
