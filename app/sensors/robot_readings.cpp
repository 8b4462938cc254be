#include "app/sensors/robot_readings.h"

#include <algorithm>

namespace rubble {
namespace {

constexpr std::int64_t kRounding = 1000;  // of a stamp at the end of a way; unit: ns

}  // namespace

const std::shared_ptr<const MotionPath>& RobotReadings::path_of(
    const Carrier& carrier, const std::shared_ptr<const MotionPath>& rig) const {
  if (!carrier.on()) return rig;
  for (const LinkWay& link : links)
    if (link.carrier == carrier) return link.path;
  static const std::shared_ptr<const MotionPath> nowhere;
  return nowhere;
}

std::int64_t RobotReadings::end_of(const Carrier& carrier, const std::shared_ptr<const MotionPath>& rig, std::int64_t start_ns,
                                   std::int64_t last_ns) const {
  return std::min(last_ns, start_ns + std::int64_t(path_of(carrier, rig)->duration() * 1e9 + 0.5) + kRounding);
}

}  // namespace rubble
