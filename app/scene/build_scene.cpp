#include "app/scene/build_scene.h"

#include <algorithm>
#include <memory>

#include "app/assets/building_assets.h"
#include "app/assets/terrain.h"
#include "app/fines/pile_fines.h"
#include "app/surroundings/pile_surroundings.h"
#include "kernel/base/portable_math.h"
#include "render/materials/paint_layers.h"
#include "render/materials/surface_appearance.h"

namespace rubble {
namespace {

Placement place(const PlacedItem& item, const AssetLibrary& assets) {
  constexpr double kRadians = portable::kPi / 180;
  Placement placement;
  placement.kind = assets.find(item);
  placement.scale = item.scale;
  placement.world_from_body = {
      portable::quat_from_rpy(item.rpy_deg.x * kRadians, item.rpy_deg.y * kRadians,
                              item.rpy_deg.z * kRadians),
      item.position};
  placement.fixed = item.fixed;
  return placement;
}

}  // namespace

PileSpec build_pile_spec(const PileScenario& pile, std::uint64_t seed, const AssetLibrary& assets) {
  PileSpec spec;
  spec.seed = seed;
  spec.types = assets.types;
  spec.assemblies = assets.assemblies;
  spec.mix = assets.mix;
  for (const PlacedItem& item : pile.placed) spec.placed.push_back(place(item, assets));
  for (const int type : assets.terrain())
    spec.placed.push_back(place_terrain(pile.terrain, type));
  spec.building = building_of(pile, seed);
  spec.building_first_type = assets.building_first_type;
  spec.structures = assets.structures;
  for (const FurnitureItem& item : pile.furniture)
    spec.furniture.push_back({assets.find(item.asset), item.per_bay, item.roof});
  spec.spawn_position = pile.spawn_position;
  spec.spawn_bounds = pile.spawn_bounds;
  spec.spawn_density = pile.spawn_density;
  spec.layers = pile.layers;
  spec.pieces_per_layer = pile.pieces_per_layer;
  return spec;
}

SceneInstance make_instance(const ClassLabels& labels, const PieceState& piece, std::size_t number) {
  SceneInstance instance;
  instance.mesh = std::uint32_t(piece.type);
  instance.scale = float(piece.scale);
  instance.world_from_body = piece.world_from_body;
  instance.id = std::uint32_t(number);
  instance.label = labels.of_type(piece.type);
  return instance;
}

void set_building_cuts(const AssetLibrary& assets, const PileState& pile, Scene& scene) {
  if (pile.building.count == 0) return;
  const std::size_t begin = std::size_t(pile.building.first);
  for (SceneInstance& instance : scene.instances) {
    if (instance.id >= begin && instance.id - begin < assets.building_cuts.size())
      instance.cut_from = assets.building_cuts[instance.id - begin];
  }
}

Scene build_scene(const Scenario& scenario, const AssetLibrary& assets, const PileState& pile) {
  const ClassLabels labels(scenario, assets.types);
  Scene scene;
  scene.meshes = assets.meshes;
  for (std::size_t i = 0; i < pile.pieces.size(); ++i) {
    const PieceState& piece = pile.pieces[i];
    if (piece.status == PieceStatus::lost) continue;
    scene.instances.push_back(make_instance(labels, piece, i));
  }
  set_building_cuts(assets, pile, scene);
  add_fines(labels, pile, scene);
  add_surroundings(labels, pile, scene);
  scene.light = resolve_light(scenario);
  scene.sky = scenario.lights.front().sky;
  for (std::size_t i = 1; i < scenario.lights.size(); ++i) scene.more_lights.push_back(scenario.lights[i].spec);
  add_street_lamps(pile, count_lamps(scenario.robots), scene);
  scene.wetness = scenario.wetness;
  scene.lamp = scenario.lamp;
  scene.air = scenario.air;
  scene.seed = scenario.seed, scene.look_seed = scenario.pile_seed();
  scene.start_ns = scenario.start_ns;
  return scene;
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
