#include "app/robots/live_imus.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/sensors/build_imu.h"

namespace rubble {

LiveImus::LiveImus(const Scenario& scenario, const std::vector<RidingSensor>& imus, double step)
    : scenario_(scenario), steps_(scenario.start_ns, step), way_(steps_) {
  const std::vector<ImuScenario> all = all_imus(scenario);
  for (const RidingSensor& at : imus)
    units_.push_back({at.number, steps_.add_carrier(at.mount),
                      std::int64_t(std::ceil(0.5e9 / all[at.number].model.rate_hz)), nullptr});
}

void LiveImus::restart(const World& world) {
  const std::vector<ImuScenario> all = all_imus(scenario_);
  for (Unit& unit : units_)
    unit.imu = std::make_unique<Imu>(build_imu(scenario_, all[unit.number], scenario_.seed, way_));
  steps_.restart(world);
}

std::vector<ImuSample> LiveImus::take() {
  std::vector<ImuSample> samples;
  std::int64_t needed = steps_.known_until();
  for (Unit& unit : units_) {
    const std::int64_t until = steps_.known_until() - unit.half_ns;
    if (unit.imu->next_stamp() <= until) {
      steps_.begin_measuring(unit.carrier);
      for (ImuSample& sample : unit.imu->take_until(until)) {
        sample.sensor = int(unit.number);
        samples.push_back(sample);
      }
      steps_.end_measuring();
    }
    needed = std::min(needed, unit.imu->next_stamp() - unit.half_ns);
  }
  steps_.forget_before(needed);
  return samples;
}

}  // namespace rubble
