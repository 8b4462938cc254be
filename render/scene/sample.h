// One sample of one sensor. Cameras, inertial units, robots and sensors of any other kind are peers, each with a rate of
// its own.
#pragma once

#include <cstdint>
#include <variant>

#include "render/scene/frame.h"
#include "render/scene/reading.h"
#include "render/scene/robot_sample.h"

namespace rubble {

using Sample = std::variant<Frame, ImuSample, RobotSample, Reading>;

inline std::int64_t stamp_of(const Sample& sample) {
  return std::visit([](const auto& s) { return s.stamp_ns; }, sample);
}

}  // namespace rubble
