// One sample of one sensor, and the interface of sensors. Cameras, inertial units, LiDARs, robots and sensors that give a
// few numbers are peers, each with a rate of its own.
#pragma once

#include <cstdint>
#include <optional>
#include <variant>

#include "render/scene/frame.h"
#include "render/scene/range_scan.h"
#include "render/scene/reading.h"
#include "render/scene/robot_sample.h"

namespace rubble {

using Sample = std::variant<Frame, ImuSample, RangeScan, RobotSample, Reading>;

inline std::int64_t stamp_of(const Sample& sample) {
  return std::visit([](const auto& s) { return s.stamp_ns; }, sample);
}

class Sensor {
 public:
  virtual ~Sensor() = default;
  // Stamp of the next sample, later than all earlier ones. Empty: there are no more samples.
  virtual std::optional<std::int64_t> next_stamp() const = 0;
  virtual Sample take() = 0;
};

}  // namespace rubble
