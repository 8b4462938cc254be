#include "kernel/settling/layer_space.h"

#include <cmath>

#include "kernel/collision/gjk.h"

namespace rubble {
namespace {

constexpr float kSpawnGap = 0.01f;  // pieces of a layer start at least so far apart; unit: m

}  // namespace

LayerSpace::LayerSpace(const ByKind<Shape>& shapes, double largest_radius)
    : shapes_(shapes), cell_size_(2 * largest_radius + kSpawnGap) {}

LayerSpace::Body LayerSpace::turn(const Placement& placement, bool with_parts) const {
  const Shape& shape = shapes_[placement.kind];
  const Pose& pose = placement.world_from_body;
  Body body;
  body.centre = pose * (shape.volume.centre_of_mass * placement.scale);
  body.radius = double(shape.radius) * placement.scale;
  if (!with_parts) return body;
  for (const ConvexShape& part : shape.parts) {
    std::vector<Vec3f>& corners = body.parts.emplace_back();
    for (const Vec3f& corner : part.corners)
      corners.push_back(Vec3f(pose.rotation.rotate(Vec3(corner) * placement.scale)));
  }
  return body;
}

LayerSpace::Cell LayerSpace::cell_of(const Vec3& p) const {
  return {long(std::floor(p.x / cell_size_)), long(std::floor(p.y / cell_size_)),
          long(std::floor(p.z / cell_size_))};
}

bool LayerSpace::are_apart(const Body& a, const Body& b) {
  const Vec3f offset(b.centre - a.centre);
  for (const std::vector<Vec3f>& pa : a.parts) {
    for (const std::vector<Vec3f>& pb : b.parts) {
      GjkCache cache;
      const GjkResult result = calc_distance({pa.data(), int(pa.size())},
                                             {pb.data(), int(pb.size())}, offset, kSpawnGap, cache);
      if (result.kind == GjkResult::Kind::overlapping) return false;
      if (result.kind == GjkResult::Kind::separated && result.distance < kSpawnGap) return false;
    }
  }
  return true;
}

bool LayerSpace::is_free(const Placement& placement) const {
  Body body = turn(placement, false);
  const auto [x, y, z] = cell_of(body.centre);
  for (long dz = -1; dz <= 1; ++dz) {
    for (long dy = -1; dy <= 1; ++dy) {
      for (long dx = -1; dx <= 1; ++dx) {
        const auto found = bodies_.find({x + dx, y + dy, z + dz});
        if (found == bodies_.end()) continue;
        for (const Body& other : found->second) {
          if (distance(other.centre, body.centre) > other.radius + body.radius + kSpawnGap)
            continue;
          if (body.parts.empty()) body = turn(placement, true);
          if (!are_apart(body, other)) return false;
        }
      }
    }
  }
  return true;
}

void LayerSpace::add(const Placement& placement) {
  Body body = turn(placement, true);
  bodies_[cell_of(body.centre)].push_back(std::move(body));
}

}  // namespace rubble
