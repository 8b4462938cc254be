#include "app/surroundings/lay_surroundings.h"

#include <memory>

#include "kernel/surroundings/make_surroundings.h"

namespace rubble {

bool is_dark(const Scenario& scenario) {
  const LightSpec light = resolve_light(scenario);
  const SkyType sky = scenario.lights.front().sky.type;
  if (light.type != LightType::sun) return light.type != LightType::directional;
  return sky == SkyType::moonlit || sky == SkyType::city_night || light.elevation_deg < 0;
}

void lay_surroundings(const Scenario& scenario, const AssetLibrary& assets, PileState& pile) {
  pile.surroundings = nullptr;
  if (!scenario.surroundings.on()) return;
  const Circle circle = find_pile_circle(pile, assets.finest_meshes());
  pile.surroundings = std::make_shared<const Surroundings>(
      make_surroundings(scenario.surroundings, scenario.seed, circle, is_dark(scenario), scenario.wetness));
}

}  // namespace rubble
