#include "app/scene/build_scene.h"

#include <algorithm>
#include <memory>

#include "app/assets/building_assets.h"
#include "app/assets/terrain.h"
#include "app/fines/seen_fines.h"
#include "app/surroundings/seen_surroundings.h"
#include "kernel/base/portable_math.h"
#include "render/materials/paint_layers.h"
#include "render/materials/surface_appearance.h"

namespace rubble {
namespace {

Placement place(const PlacedItem& item, const AssetLibrary& assets) {
  constexpr double kRadians = portable::kPi / 180;
  Placement placement;
  placement.type = assets.find(item);
  placement.scale = item.scale;
  placement.world_from_body = {
      portable::quat_from_rpy(item.rpy_deg.x * kRadians, item.rpy_deg.y * kRadians,
                              item.rpy_deg.z * kRadians),
      item.position};
  placement.fixed = item.fixed;
  return placement;
}

}  // namespace

PileSpec build_pile_spec(const Scenario& scenario, const AssetLibrary& assets) {
  PileSpec spec;
  spec.seed = scenario.seed;
  spec.types = assets.types;
  spec.assemblies = assets.assemblies;
  spec.mix = assets.mix;
  for (const PlacedItem& item : scenario.pile.placed) spec.placed.push_back(place(item, assets));
  for (const int type : assets.terrain())
    spec.placed.push_back(place_terrain(scenario.pile.terrain, type));
  spec.building = building_of(scenario);
  spec.building_first_type = assets.building_first_type;
  for (const FurnitureItem& item : scenario.pile.furniture)
    spec.furniture.push_back({assets.find(item.asset), item.per_bay, item.roof});
  spec.spawn_position = scenario.pile.spawn_position;
  spec.spawn_bounds = scenario.pile.spawn_bounds;
  spec.spawn_density = scenario.pile.spawn_density;
  spec.layers = scenario.pile.layers;
  spec.pieces_per_layer = scenario.pile.pieces_per_layer;
  return spec;
}

SceneInstance make_instance(const PieceState& piece, std::size_t number) {
  SceneInstance instance;
  instance.mesh = std::uint32_t(piece.type);
  instance.scale = float(piece.scale);
  instance.world_from_body = piece.world_from_body;
  instance.id = std::uint32_t(number);
  instance.label = std::uint16_t(kFirstAssetLabel + piece.type);
  return instance;
}

// The pieces of a building are together in a pile, in their order.
void set_building_cuts(const AssetLibrary& assets, const PileState& pile, Scene& scene) {
  if (assets.building_cuts.empty()) return;
  const int first_type = assets.building_first_type, types = int(assets.building_counts.size());
  const auto first = std::find_if(pile.pieces.begin(), pile.pieces.end(), [&](const PieceState& piece) {
    return piece.type >= first_type && piece.type < first_type + types;
  });
  const std::size_t begin = std::size_t(first - pile.pieces.begin());
  for (SceneInstance& instance : scene.instances) {
    if (instance.id >= begin && instance.id - begin < assets.building_cuts.size())
      instance.cut_from = assets.building_cuts[instance.id - begin];
  }
}

Scene build_scene(const Scenario& scenario, const AssetLibrary& assets, const PileState& pile) {
  Scene scene;
  scene.meshes = assets.meshes;
  for (std::size_t i = 0; i < pile.pieces.size(); ++i) {
    const PieceState& piece = pile.pieces[i];
    if (piece.status == PieceStatus::lost) continue;
    scene.instances.push_back(make_instance(piece, i));
  }
  set_building_cuts(assets, pile, scene);
  add_fines(scenario, assets, pile, scene);
  add_surroundings(scenario, assets, pile, scene);
  scene.light = resolve_light(scenario);
  scene.sky = scenario.light.sky;
  scene.more_lights = scenario.lights;
  add_street_lamps(pile, count_lamps(scenario.robots), scene);
  scene.wetness = scenario.wetness;
  scene.lamp = scenario.lamp;
  scene.air = scenario.air;
  scene.seed = scenario.seed;
  scene.start_ns = scenario.start_ns;
  return scene;
}

std::vector<std::string> label_names(const Scenario& scenario, const AssetLibrary& assets) {
  std::vector<std::string> names{"sky", "ground"};
  for (const PieceType& type : assets.types) names.push_back(type.name);
  if (!scenario.robots.empty()) names.push_back("robot");
  if (scenario.fines.amount > 0) names.insert(names.end(), fine_names().begin(), fine_names().end());
  if (scenario.surroundings.on())
    names.insert(names.end(), surrounding_names().begin(), surrounding_names().end());
  return names;
}

namespace {

PileModel build_model(const AssetLibrary& assets, const PileState& pile, bool lost_too) {
  PileModel model;
  for (std::size_t i = 0; i < assets.types.size(); ++i)
    model.types.push_back({assets.types[i].name, &assets.meshes[i]->levels.front()});
  for (std::size_t i = 0; i < pile.pieces.size(); ++i) {
    const PieceState& piece = pile.pieces[i];
    if (piece.status == PieceStatus::lost && !lost_too) continue;
    model.pieces.push_back({std::uint32_t(piece.type),
                            piece_name(assets.types[std::size_t(piece.type)].name, i), piece.scale,
                            piece.world_from_body, std::int32_t(i)});
  }
  for (const SurfaceAppearance& look : all_surface_appearances())
    model.surface_appearance.push_back({look.name, (look.dark + look.light) * 0.5f});
  for (const auto& mesh : assets.meshes)
    for (const TriangleMesh& level : mesh->levels)
      for (std::size_t s = 0; s < level.surface_names.size(); ++s)
        if (level.paint_of(s)) model.surface_appearance.push_back({level.surface_names[s], mean_paint(level, s)});
  return model;
}

}  // namespace

PileModel build_pile_model(const AssetLibrary& assets, const PileState& pile) {
  PileModel model = build_model(assets, pile, false);
  add_fines(pile, model);
  add_surroundings(pile, model);
  return model;
}

PileModel build_track_model(const AssetLibrary& assets, const PileState& pile) {
  return build_model(assets, pile, true);
}

}  // namespace rubble
