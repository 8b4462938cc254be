#include "app/navigate/range_scanner.h"

#include <utility>

#include "scripting/sensors/lidar.h"

namespace rubble {
namespace {

LidarFigures figures_of(const NavigationRules& rules) {
  LidarFigures figures;
  figures.model = LidarModel::os0, figures.channels = 32, figures.columns = 512;
  figures.rate_hz = 1 / rules.period;
  return figures;
}

}  // namespace

SensorItem make_range_scanner(const NavigationRules& rules, const std::string& name) { return make_lidar_item(name, figures_of(rules)); }

RangeScanner make_range_scanner(const NavigationWorld& world, std::uint64_t seed, std::function<Pose(double time)> world_from_base) {
  const Scenario& scenario = world.mission().scenario;
  const std::int64_t start = scenario.start_ns;
  const Pose base_from_scanner{{1, 0, 0, 0}, {0, 0, world.rules().scanner_height}};
  const auto place = [world_from_base = std::move(world_from_base), base_from_scanner, start](std::int64_t stamp) {
    return world_from_base(double(stamp - start) * 1e-9) * base_from_scanner;
  };
  return {figures_of(world.rules()).spec(), world.ray_world(), {place, start}, Medium(scenario.air, scenario.seed), seed, world.threads()};
}

}  // namespace rubble
