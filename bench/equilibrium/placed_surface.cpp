#include "bench/equilibrium/placed_surface.h"

#include <algorithm>

namespace rubble {
namespace {

Vec3 closest_on_edge(const Vec3& a, const Vec3& b, const Vec3& p) {
  const Vec3 ab = b - a;
  const double t = dot(p - a, ab) / dot(ab, ab);
  return a + ab * std::min(1.0, std::max(0.0, t));
}

}  // namespace

PlacedSurfaces::PlacedSurfaces(const std::vector<PieceType>& types, const PileState& state) {
  for (std::size_t i = 0; i < state.pieces.size(); ++i) {
    const PieceState& piece = state.pieces[i];
    const TriangleMesh* mesh = types[std::size_t(piece.type)].surface.get();
    if (!mesh || piece.status == PieceStatus::lost) continue;
    for (const auto& corners : mesh->triangles) {
      PlacedTriangle t;
      t.piece = int(i);
      for (int k = 0; k < 3; ++k) {
        t.corners[k] = piece.world_from_body * (Vec3(mesh->positions[corners[k]]) * piece.scale);
        t.box.include(t.corners[k]);
      }
      t.normal = normalized(cross(t.corners[1] - t.corners[0], t.corners[2] - t.corners[0]));
      if (norm(t.normal) == 0) continue;
      widest_ = std::max(widest_, t.box.max.x - t.box.min.x);
      triangles_.push_back(t);
    }
  }
  std::sort(triangles_.begin(), triangles_.end(),
            [](const auto& p, const auto& q) { return p.box.min.x < q.box.min.x; });
}

std::vector<const PlacedTriangle*> PlacedSurfaces::find(const Aabb& box) const {
  std::vector<const PlacedTriangle*> found;
  const auto first = std::lower_bound(
      triangles_.begin(), triangles_.end(), box.min.x - widest_,
      [](const PlacedTriangle& t, double x) { return t.box.min.x < x; });
  for (auto t = first; t != triangles_.end() && t->box.min.x <= box.max.x; ++t) {
    if (t->box.max.x >= box.min.x && t->box.min.y <= box.max.y && t->box.max.y >= box.min.y &&
        t->box.min.z <= box.max.z && t->box.max.z >= box.min.z)
      found.push_back(&*t);
  }
  return found;
}

Vec3 closest_point(const PlacedTriangle& t, const Vec3& point) {
  const Vec3 foot = point - t.normal * dot(point - t.corners[0], t.normal);
  bool inside = true;
  Vec3 best;
  double nearest = 1e300;
  for (int i = 0; i < 3; ++i) {
    const Vec3 &a = t.corners[i], &b = t.corners[(i + 1) % 3];
    inside = inside && dot(cross(b - a, foot - a), t.normal) >= 0;
    const Vec3 on_edge = closest_on_edge(a, b, point);
    if (distance(on_edge, point) >= nearest) continue;
    nearest = distance(on_edge, point);
    best = on_edge;
  }
  return inside ? foot : best;
}

}  // namespace rubble
