// Recorders turn frames into files. Each writes to "NAME.part" and renames on finish().
#pragma once

#include <string>

#include "render/scene/sample.h"

namespace rubble {

class Recorder {
 public:
  virtual ~Recorder() = default;  // without finish(): removes what it wrote
  // Samples come in the order of their stamps; of one stamp, robots, inertial units and scans before
  // frames.
  // A frame that is missing or out of order throws RunError.
  virtual void write(const Frame& frame) = 0;
  // Unless a format has a place for it, left out.
  virtual void write_imu(const ImuSample&) {}
  virtual void write_robot(const RobotSample&) {}
  virtual void write_lidar(const LidarScan&) {}
  // Completes the files and gives them their final names.
  virtual void finish() = 0;
};

inline void write_sample(Recorder& recorder, const Sample& sample) {
  if (const auto* frame = std::get_if<Frame>(&sample))
    recorder.write(*frame);
  else if (const auto* reading = std::get_if<ImuSample>(&sample))
    recorder.write_imu(*reading);
  else if (const auto* scan = std::get_if<LidarScan>(&sample))
    recorder.write_lidar(*scan);
  else
    recorder.write_robot(std::get<RobotSample>(sample));
}

}  // namespace rubble
