#include "render/geometry/moving_pieces.h"

#include "kernel/base/error.h"

namespace rubble {

namespace {

bool same(const std::optional<Pose>& a, const std::optional<Pose>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return a->rotation == b->rotation && a->translation == b->translation;
}

}  // namespace

MovingPieces::MovingPieces(const Scene& scene, PreparedScene& prepared)
    : motion_(scene.motion), prepared_(prepared) {
  if (any() && !motion_.poses_at) throw RunError("the scene moves, but does not say where it is");
  remove_all();
}

void MovingPieces::remove_all() {
  if (!any()) return;
  poses_.assign(motion_.moving.size(), std::nullopt);
  for (const std::uint32_t i : motion_.moving) prepared_.placed[i].there = false;
  now_.reset();
  ++prepared_.moment;
}

void MovingPieces::place(std::size_t i, const std::optional<Pose>& pose) {
  PlacedMesh& piece = prepared_.placed[motion_.moving[i]];
  piece.there = pose.has_value();
  if (!pose) return;
  piece.world_from_mesh = *pose;
  const PreparedMesh& mesh = prepared_.meshes[piece.mesh];
  piece.centre = Vec3f(*pose * (Vec3(mesh.centre) * piece.scale));
}

bool MovingPieces::move_to(std::int64_t stamp_ns) {
  if (!any() || now_ == stamp_ns) return false;
  now_ = stamp_ns;
  const std::vector<std::optional<Pose>> poses = motion_.poses_at(stamp_ns);
  bool moved = false;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    if (same(poses[i], poses_[i])) continue;
    place(i, poses[i]);
    moved = true;
  }
  poses_ = poses;
  prepared_.moment += moved;
  return moved;
}

MovingPieces::Shift MovingPieces::shift_to(std::int64_t stamp_ns) const {
  Shift shift;
  if (!any()) return shift;
  shift.moves.assign(prepared_.placed.size(), 0);
  shift.then.resize(prepared_.placed.size());
  const std::vector<std::optional<Pose>> poses = motion_.poses_at(stamp_ns);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    shift.moves[motion_.moving[i]] = 1;
    shift.then[motion_.moving[i]] = poses[i];
  }
  return shift;
}

}  // namespace rubble
