#include "app/scene/moving_scene.h"

#include "app/scene/build_scene.h"
#include "kernel/robot/parts.h"

namespace rubble {
namespace {

// What lies outside the window and may still be seen: exposures, and rows of a shutter; unit: s
constexpr double kAround = 1;

constexpr double kLiveReach = 5;  // beyond what lies there; unit: m

double seconds_between(std::int64_t zero_ns, std::int64_t stamp_ns) {
  return double(stamp_ns - zero_ns) * 1e-9;
}

void include_keys(const TrackBody& body, Aabb& reach) {
  for (const TrackKey& key : body.keys) reach.include(key.world_from_body.translation);
}

// Pieces that were lost in the end were there before: they come last, so that the others keep their
// looks.
void add_lost(const ClassLabels& labels, const AssetLibrary& assets, const PileState& pile, Scene& scene) {
  for (std::size_t i = 0; i < pile.pieces.size(); ++i) {
    const PieceState& piece = pile.pieces[i];
    if (piece.status == PieceStatus::lost) scene.instances.push_back(make_instance(labels, piece, i));
  }
  set_building_cuts(assets, pile, scene);
}

// The number of what moves an instance: its own, and of a heap of fines that of the piece it lies on.
std::int32_t find_mover(const SceneInstance& instance, const Fines& fines) {
  if (instance.id < std::uint32_t(kFirstFineHeap)) return std::int32_t(instance.id);
  if (instance.surrounds) return -1;  // it stands
  return fines.heaps()[instance.id - std::uint32_t(kFirstFineHeap)].host;
}

// Sets what of the scene is in the track in motion, with the fines on it.
void set_in_motion(const Track& track, const TrackWindow& window, std::int64_t zero_ns, const Fines& fines, Scene& scene) {
  std::vector<const TrackBody*> bodies;
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    SceneInstance& instance = scene.instances[i];
    const TrackBody* const body = track.find(find_mover(instance, fines));
    if (!body) continue;
    if (track.rests_throughout(*body, window.from, window.to + kAround)) {
      instance.world_from_body = track.motion_at(*body, window.from)->world_from_body;
      continue;
    }
    scene.motion.moving.push_back(std::uint32_t(i));
    include_keys(*body, scene.motion.reach);
    bodies.push_back(body);
  }
  scene.motion.poses_at = [bodies, &track, zero_ns](std::int64_t stamp_ns) {
    std::vector<std::optional<Pose>> poses;
    poses.reserve(bodies.size());
    for (const TrackBody* body : bodies) {
      const auto motion = track.motion_at(*body, seconds_between(zero_ns, stamp_ns));
      poses.push_back(motion ? std::optional<Pose>(motion->world_from_body) : std::nullopt);
    }
    return poses;
  };
}

void add_robot(const RobotModel& model, int first_piece, std::uint16_t label, Scene& scene) {
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const RobotLink& link = model.links[i];
    if (link.parts.empty() && link.looks.triangles.empty()) continue;
    SceneMesh mesh;
    mesh.levels = {make_link_mesh(link, choose_link_surface(model, i))};
    scene.meshes.push_back(std::make_shared<SceneMesh>(std::move(mesh)));
    SceneInstance instance;
    instance.mesh = std::uint32_t(scene.meshes.size()) - 1;
    instance.id = std::uint32_t(first_piece) + std::uint32_t(i);
    instance.label = label;
    for (const RobotLamp& lamp : model.lamps)
      if (std::size_t(lamp.link) == i)
        scene.carried_lights.push_back(
            {std::uint32_t(scene.instances.size()), lamp.link_from_lamp, lamp.intensity_cd, lamp.cone_deg});
    scene.instances.push_back(instance);
  }
}

Scene build_scene_with(const RobotTrack& robots, const Scenario& scenario, const AssetLibrary& assets, const PileState& pile) {
  Scene scene = build_scene(scenario, assets, pile);
  const std::uint16_t label = ClassLabels(scenario, assets.types).of_robots();
  for (std::size_t i = 0; i < robots.models.size(); ++i)
    add_robot(robots.models[i], robots.first_piece[i], label, scene);
  return scene;
}

}  // namespace

Scene build_moving_scene(const Scenario& scenario, const AssetLibrary& assets, const PileState& pile,
                         const Track& track, const TrackWindow& window, std::int64_t zero_ns) {
  PileState without_fines = pile;  // they come when all rests
  without_fines.fines = {};
  Scene scene = build_scene(scenario, assets, without_fines);
  add_lost(ClassLabels(scenario, assets.types), assets, pile, scene);
  set_in_motion(track, window, zero_ns, {}, scene);
  return scene;
}

Scene build_robot_scene(const Scenario& scenario, const AssetLibrary& assets, const PileState& pile,
                        const RobotTrack& robots, std::int64_t start_ns) {
  Scene scene = build_scene_with(robots, scenario, assets, pile);
  scene.start_ns = start_ns;
  set_in_motion(robots.track, {robots.track.begin(), robots.track.end()}, start_ns, pile.fines, scene);
  return scene;
}

std::optional<Pose> pose_in_track(const Track& track, int id, std::int64_t since_ns) {
  const TrackBody* const body = track.find(id);
  if (!body) return std::nullopt;
  const auto motion = track.motion_at(*body, seconds_between(0, since_ns));
  return motion ? std::optional<Pose>(motion->world_from_body) : std::nullopt;
}

Scene build_live_scene(const Scenario& scenario, const AssetLibrary& assets, const PileState& pile,
                       const RobotTrack& robots, std::int64_t start_ns, LivePose pose_of) {
  Scene scene = build_scene_with(robots, scenario, assets, pile);
  scene.start_ns = start_ns;
  const bool fixed_debris = scenario.robot_run.debris == DebrisMotion::fixed;
  std::vector<int> movers;
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const int mover = find_mover(scene.instances[i], pile.fines);
    if (mover < 0) continue;  // it stands or lies on the ground
    const bool piece = std::size_t(mover) < pile.pieces.size();
    if (piece && (fixed_debris || pile.pieces[std::size_t(mover)].status == PieceStatus::fixed)) continue;
    scene.motion.moving.push_back(std::uint32_t(i));
    if (const auto pose = pose_of(mover, start_ns)) scene.instances[i].world_from_body = *pose;
    scene.motion.reach.include(scene.instances[i].world_from_body.translation);
    movers.push_back(mover);
  }
  scene.motion.may_rest = true;
  // Where robots and what they push may get to.
  scene.motion.reach.include(scene.motion.reach.min - Vec3{kLiveReach, kLiveReach, 0});
  scene.motion.reach.include(scene.motion.reach.max + Vec3{kLiveReach, kLiveReach, kLiveReach});
  scene.motion.poses_at = [movers, pose_of = std::move(pose_of)](std::int64_t stamp_ns) {
    std::vector<std::optional<Pose>> poses;
    poses.reserve(movers.size());
    for (const int mover : movers) poses.push_back(pose_of(mover, stamp_ns));
    return poses;
  };
  return scene;
}

}  // namespace rubble
