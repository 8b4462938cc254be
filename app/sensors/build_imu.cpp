#include "app/sensors/build_imu.h"

#include <optional>

#include "kernel/base/random.h"

namespace rubble {

Imu build_imu(const ImuScenario& imu, double gravity, std::uint64_t noise_seed, std::int64_t start_ns, const MotionPath& path) {
  const std::uint64_t seed =
      imu.named ? RandomStream(noise_seed, "imus/" + imu.name).next() : noise_seed;
  return Imu(path, imu.model, gravity, seed, start_ns,
             imu.is_rig() ? std::nullopt : std::optional(imu.rig_from_imu()));
}

}  // namespace rubble
