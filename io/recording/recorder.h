// Recorders write samples to files. Each writes to "NAME.part" and renames it in finish().
#pragma once

#include <string>

#include "render/scene/sample.h"

namespace rubble {

class Recorder {
 public:
  virtual ~Recorder() = default;  // without finish(): removes its files
  // Samples come in the order of their stamps. With equal stamps, all others come before frames.
  // Throws RunError for a frame that is missing or out of order.
  virtual void write(const Frame& frame) = 0;
  // Formats without a place for these samples leave them out.
  virtual void write_imu(const ImuSample&) {}
  virtual void write_robot(const RobotSample&) {}
  virtual void write_reading(const Reading&) {}
  // Completes the files and gives them their final names.
  virtual void finish() = 0;
};

inline void write_sample(Recorder& recorder, const Sample& sample) {
  if (const auto* frame = std::get_if<Frame>(&sample))
    recorder.write(*frame);
  else if (const auto* reading = std::get_if<ImuSample>(&sample))
    recorder.write_imu(*reading);
  else if (const auto* values = std::get_if<Reading>(&sample))
    recorder.write_reading(*values);
  else
    recorder.write_robot(std::get<RobotSample>(sample));
}

}  // namespace rubble
