#include "app/sensors/robot_readings.h"

#include <algorithm>
#include <stdexcept>

namespace rubble {

const std::shared_ptr<const MotionPath>& RobotReadings::path_of(
    const Carrier& carrier, const std::shared_ptr<const MotionPath>& rig) const {
  if (!carrier.on()) return rig;
  for (const LinkWay& link : links)
    if (link.carrier == carrier) return link.path;
  throw std::logic_error("the way of a carrier was not kept");
}

std::int64_t RobotReadings::end_of(const Carrier& carrier, std::int64_t start_ns, std::int64_t last_ns) const {
  if (!carrier.on()) return last_ns;
  const double driven = path_of(carrier, nullptr)->duration();
  return std::min(last_ns, start_ns + std::int64_t(driven * 1e9 + 0.5));
}

}  // namespace rubble
