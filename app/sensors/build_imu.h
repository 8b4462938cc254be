// From an inertial unit of a mission to what measures.
#pragma once

#include <cstdint>

#include "scripting/scenario/scenario.h"
#include "scripting/trajectory/imu.h"
#include "scripting/trajectory/motion_path.h"

namespace rubble {

// Of several units each has noise of its own. noise_seed: of all sensors. path: of its carrier; must outlive the unit.
Imu build_imu(const Scenario& scenario, const ImuScenario& imu, std::uint64_t noise_seed, const MotionPath& path);

}  // namespace rubble
