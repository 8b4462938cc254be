// From an inertial unit of a mission to what measures.
#pragma once

#include <cstdint>

#include "scripting/scenario/scenario.h"
#include "scripting/trajectory/imu.h"
#include "scripting/trajectory/motion_path.h"

namespace rubble {

// Each unit with a name has noise of its own. noise_seed: of all sensors. path: of its carrier, from start_ns on; must
// outlive the unit. gravity: unit: m/s2
Imu build_imu(const ImuScenario& imu, double gravity, std::uint64_t noise_seed, std::int64_t start_ns, const MotionPath& path);

}  // namespace rubble
