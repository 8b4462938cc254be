#include "render/transport/lamp_reach.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace rubble {

namespace {

// The octahedral map of all directions.
Vec3f direction_of(int x, int y) {
  const float u = (float(x) + 0.5f) / LampReach::kSide * 2 - 1, v = (float(y) + 0.5f) / LampReach::kSide * 2 - 1;
  Vec3f d(u, v, 1 - std::fabs(u) - std::fabs(v));
  const float t = std::max(-d.z, 0.0f);
  d.x += d.x >= 0 ? -t : t, d.y += d.y >= 0 ? -t : t;
  return normalized(d);
}

}  // namespace

LampReach::LampReach(const PreparedScene& scene, SceneRays& rays, std::vector<std::uint8_t> counted, ThreadPool& pool)
    : scene_(scene), rays_(rays), counted_(std::move(counted)), pool_(pool), map_(std::size_t(kSide) * kSide) {}

void LampReach::aim(const PlacedLamp& lamp, float extinction) {
  lamp_ = lamp, extinction_ = extinction;
  cast_map();
  seen_.clear();
  for (std::uint32_t piece = 0; piece < scene_.placed.size(); ++piece)
    if (counted_[piece] && may_see(scene_.placed[piece])) seen_.push_back(piece);
}

void LampReach::cast_map() {
  const RayScene& scene_rays = rays_.solid();
  pool_.run(kSide, 8, [&](int begin, int end) {
    std::array<RayScene::Ray, kSide> rays;
    std::array<RayScene::PreciseHit, kSide> hits;
    for (int y = begin; y < end; ++y) {
      for (int x = 0; x < kSide; ++x) rays[std::size_t(x)] = {lamp_.position, 0, direction_of(x, y), kReach};
      scene_rays.cast_many(rays.data(), rays.size(), RayScene::Order::coherent, hits.data());
      for (std::size_t x = 0; x < kSide; ++x)
        map_[std::size_t(y) * kSide + x] = hits[x].triangle == RayScene::kNone ? kReach : hits[x].distance;
    }
  });
}

float LampReach::distance_towards(const Vec3f& d) const {
  const float flat = 1 / (std::fabs(d.x) + std::fabs(d.y) + std::fabs(d.z));
  float u = d.x * flat, v = d.y * flat;
  if (d.z < 0) {
    const float folded = (1 - std::fabs(v)) * (u >= 0 ? 1.0f : -1.0f);
    v = (1 - std::fabs(u)) * (v >= 0 ? 1.0f : -1.0f);
    u = folded;
  }
  const auto texel = [](float a) { return std::clamp(int((a * 0.5f + 0.5f) * kSide), 0, kSide - 1); };
  return map_[std::size_t(texel(v) * kSide + texel(u))];
}

// Not where all of it lies behind what the lamp meets first.
bool LampReach::may_see(const PlacedMesh& piece) const {
  const Vec3f way = piece.centre - lamp_.position;
  const float away = norm(way);
  if (away - piece.radius > kReach) return false;
  // A piece that fills more than a few directions may stick out somewhere.
  if (away < 12 * piece.radius) return true;
  return shines_on(way * (1 / away), away - piece.radius);
}

LampAim LampReach::aim_of_device() const {
  LampAim out;
  out.position = lamp_.position, out.axis = lamp_.axis, out.intensity = lamp_.intensity, out.cone = lamp_.cone;
  out.extinction = extinction_, out.map = &map_, out.seen = &seen_, out.map_side = kSide;
  out.reach = kReach, out.fade = kFade, out.near = kNear, out.slack = kSlack;
  return out;
}

float LampReach::open_share() const {
  return float(std::count(map_.begin(), map_.end(), kReach)) / float(map_.size());
}

float LampReach::kept_at(float away) { return std::clamp((kReach - away) / kFade, 0.0f, 1.0f); }

}  // namespace rubble
