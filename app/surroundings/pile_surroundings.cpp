#include "app/surroundings/pile_surroundings.h"

#include <memory>
#include <string>

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
      make_surroundings(scenario.surroundings, scenario.pile_seed(), circle, is_dark(scenario), scenario.wetness));
}

namespace {

// A light-emitting diode lamp of about 5,000 lm at 7 m, which gives 20 lx below it and a mean near 10 lx: class P1
// of EN 13201-2 asks for a mean of 15 lx, P2 for 10 lx.
constexpr double kLampIntensity = 1.0;  // unit: kcd
constexpr double kLampCone = 150;       // unit: degree
constexpr std::size_t kFarLamps = 12;   // besides, of which light is found

LightSpec lamp_at(const Vec3& place) {
  LightSpec light;
  light.type = LightType::spot;
  light.intensity = kLampIntensity, light.cone_deg = kLampCone;
  light.rpy_deg = {0, 90, 0};
  light.position = place;
  return light;
}

}  // namespace

void add_surroundings(const ClassLabels& labels, const PileState& pile, Scene& scene) {
  if (!pile.surroundings) return;
  const std::uint32_t first = std::uint32_t(scene.meshes.size());
  for (const auto& mesh : pile.surroundings->meshes) {
    auto seen = std::make_shared<SceneMesh>();
    seen->levels = mesh->levels, seen->light_spacing = mesh->light_spacing;
    scene.meshes.push_back(std::move(seen));
  }
  std::uint32_t number = std::uint32_t(kFirstSurrounding);
  for (const SurroundingThing& thing : pile.surroundings->things) {
    SceneInstance instance;
    instance.mesh = first + thing.mesh;
    instance.scale = float(thing.scale);
    instance.world_from_body = thing.world_from_mesh;
    instance.id = number++;
    instance.label = labels.of(thing.kind);
    instance.surrounds = true;
    scene.instances.push_back(instance);
  }
}

void add_street_lamps(const PileState& pile, std::size_t reserved, Scene& scene) {
  if (!pile.surroundings || !pile.surroundings->lit) return;
  std::size_t left = kFarLamps;
  for (const Vec3& place : pile.surroundings->lamps) {
    if (scene.more_lights.size() + 1 + reserved < kMostLights)
      scene.more_lights.push_back(lamp_at(place));
    else if (left-- > 0)
      scene.far_lights.push_back(lamp_at(place));
    else
      return;
  }
}

void add_surroundings(const PileState& pile, PileModel& model) {
  if (!pile.surroundings) return;
  const std::size_t first = model.types.size();
  for (std::size_t i = 0; i < pile.surroundings->meshes.size(); ++i)
    model.types.push_back({"surroundings_" + std::to_string(i), &pile.surroundings->meshes[i]->levels.front()});
  std::size_t number = kFirstSurrounding;
  for (const SurroundingThing& thing : pile.surroundings->things) {
    const std::string& kind = surrounding_names()[std::size_t(thing.kind)];
    model.pieces.push_back({std::uint32_t(first + thing.mesh), piece_name(kind, number), thing.scale,
                            thing.world_from_mesh, std::int32_t(number)});
    ++number;
  }
}

void add_surroundings(const ClassLabels& labels, const PileState& pile, Legend& legend) {
  if (!pile.surroundings) return;
  legend.first_surrounding = std::uint32_t(kFirstSurrounding);
  for (const SurroundingThing& thing : pile.surroundings->things)
    legend.surroundings.push_back(
        {labels.of(thing.kind), surrounding_names()[std::size_t(thing.kind)]});
}

}  // namespace rubble
