#include "app/sensors/build_imu.h"

#include <optional>

#include "kernel/base/random.h"

namespace rubble {

Imu build_imu(const Scenario& scenario, const ImuScenario& imu, std::uint64_t noise_seed, const MotionPath& path) {
  const std::uint64_t seed =
      scenario.imus.empty() ? noise_seed : RandomStream(noise_seed, "imus/" + imu.name).next();
  return Imu(path, imu.model, scenario.settle.gravity, seed, scenario.start_ns,
             imu.is_rig() ? std::nullopt : std::optional(imu.rig_from_imu()));
}

}  // namespace rubble
