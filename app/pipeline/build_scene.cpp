#include "app/pipeline/build_scene.h"

#include <memory>

#include "app/assets/terrain.h"
#include "kernel/base/portable_math.h"
#include "kernel/base/random.h"
#include "render/materials/surface_appearance.h"
#include "scripting/trajectory/trajectory.h"

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
  spec.spawn_position = scenario.pile.spawn_position;
  spec.spawn_bounds = scenario.pile.spawn_bounds;
  spec.spawn_density = scenario.pile.spawn_density;
  spec.layers = scenario.pile.layers;
  spec.pieces_per_layer = scenario.pile.pieces_per_layer;
  return spec;
}

Scene build_scene(const Scenario& scenario, const AssetLibrary& assets, const PileState& pile) {
  Scene scene;
  scene.meshes = assets.meshes;
  for (std::size_t i = 0; i < pile.pieces.size(); ++i) {
    const PieceState& piece = pile.pieces[i];
    if (piece.status == PieceStatus::lost) continue;
    scene.instances.push_back({std::uint32_t(piece.type), float(piece.scale), piece.world_from_body,
                               std::uint32_t(i), std::uint16_t(kFirstAssetLabel + piece.type)});
  }
  scene.light = resolve_light(scenario);
  scene.more_lights = scenario.lights;
  scene.wetness = scenario.wetness;
  scene.lamp = scenario.lamp;
  scene.air = scenario.air;
  scene.seed = scenario.seed;
  scene.start_ns = scenario.start_ns;
  return scene;
}

CameraSpec build_camera(const Scenario& scenario, const MountedCamera& mounted, int threads) {
  const CameraScenario& camera = mounted.camera;
  CameraSpec spec;
  spec.intrinsics = camera.intrinsics();
  spec.channels = camera.channel_set();
  spec.baseline = camera.stereo_baseline;
  spec.shutter = camera.shutter;
  spec.exposure = camera.exposure;
  spec.sensor = camera.sensor;
  spec.depth_sensor = mounted.depth_sensor;
  spec.event_camera = mounted.event_camera;
  spec.seed = scenario.seed;
  if (!mounted.is_rig()) spec.rig_from_camera = mounted.rig_from_camera();
  if (!scenario.cameras.empty())  // each has noise of its own
    spec.seed = RandomStream(scenario.seed, "cameras/" + mounted.name).next();
  spec.threads = threads;
  return spec;
}

std::vector<std::string> label_names(const AssetLibrary& assets) {
  std::vector<std::string> names{"sky", "ground"};
  for (const PieceType& type : assets.types) names.push_back(type.name);
  return names;
}

PileModel build_pile_model(const AssetLibrary& assets, const PileState& pile) {
  PileModel model;
  for (std::size_t i = 0; i < assets.types.size(); ++i)
    model.types.push_back({assets.types[i].name, &assets.meshes[i]->levels.front()});
  for (std::size_t i = 0; i < pile.pieces.size(); ++i) {
    const PieceState& piece = pile.pieces[i];
    if (piece.status == PieceStatus::lost) continue;
    model.pieces.push_back({std::uint32_t(piece.type),
                            piece_name(assets.types[std::size_t(piece.type)].name, i), piece.scale,
                            piece.world_from_body});
  }
  for (const SurfaceAppearance& look : all_surface_appearances())
    model.surface_appearance.push_back({look.name, (look.dark + look.light) * 0.5f});
  return model;
}

Flight build_flight(const Scenario& scenario, const MountedCamera& camera) {
  // The same bits where the camera is the rig.
  const bool mounted = !camera.is_rig();
  const Pose rig_from_camera = camera.rig_from_camera();
  const auto on_mount = [=](const Pose& rig) { return mounted ? rig * rig_from_camera : rig; };
  TrajectorySpec spec = scenario.trajectory;
  spec.rate_hz = camera.rate_hz.value_or(spec.rate_hz);
  Flight flight;
  for (const CameraPose& pose : sample_trajectory(spec, scenario.start_ns)) {
    flight.stamps_ns.push_back(pose.stamp_ns);
    flight.world_from_camera.push_back(on_mount(pose.world_from_camera));
  }
  const auto path = std::make_shared<CameraPath>(scenario.trajectory);
  flight.pose_at = [path, on_mount, start = scenario.start_ns](std::int64_t stamp_ns) {
    return on_mount(path->at(double(stamp_ns - start) * 1e-9));
  };
  return flight;
}

}  // namespace rubble
