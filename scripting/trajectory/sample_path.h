// Frames along a path that is made already.
#pragma once

#include <cstdint>
#include <vector>

#include "scripting/trajectory/trajectory.h"

namespace rubble {

// As sample_trajectory(), of the path of that trajectory, or of a ride. rate_hz: of the frames; unit: Hz;
// above 0.
std::vector<CameraPose> sample_path(const MotionPath& path, double rate_hz, std::int64_t epoch_ns);

}  // namespace rubble
