#include "render/transport/lamp_bounce.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/parallel.h"
#include "kernel/base/portable_math.h"
#include "render/lighting/light_packing.h"
#include "render/lighting/reflected_light.h"

namespace rubble {

namespace {

constexpr int kSide = 80;            // of the map of distances; a direction is about 1.9 degrees wide
constexpr float kReach = 10;         // of the lamp's light, and of what comes of it; unit: m
constexpr float kFade = 2;           // over which it ends; unit: m
constexpr float kNear = 0.03f;       // what lies so little behind what the map says is lit; unit: m
constexpr float kSlack = 0.03f;      // the same, as a share of the distance
constexpr float kMostAgain = 0.6f;   // share of light that comes back from a bounce, at most

// Of light so far from the lamp.
float kept_at(float away) { return std::clamp((kReach - away) / kFade, 0.0f, 1.0f); }

// The octahedral map of all directions.
Vec3f direction_of(int x, int y) {
  const float u = (float(x) + 0.5f) / kSide * 2 - 1, v = (float(y) + 0.5f) / kSide * 2 - 1;
  Vec3f d(u, v, 1 - std::fabs(u) - std::fabs(v));
  const float t = std::max(-d.z, 0.0f);
  d.x += d.x >= 0 ? -t : t, d.y += d.y >= 0 ? -t : t;
  return normalized(d);
}

}  // namespace

LampBounce::LampBounce(const PreparedScene& scene, BakeLinks links, std::vector<std::uint32_t> first_point,
                       int threads)
    : scene_(scene),
      links_(std::move(links)),
      first_point_(std::move(first_point)),
      threads_(threads),
      rays_(scene, RayScene::Detail::finest),
      map_(std::size_t(kSide) * kSide) {
  points_.resize(links_.albedos.size());
  radiance_.resize(points_.size()), arrived_.resize(points_.size());
  for (std::size_t piece = 0; piece < scene.placed.size(); ++piece) {
    if (first_point_[piece] == kNoPoints) continue;
    const PlacedMesh& placed = scene.placed[piece];
    const std::vector<BakePoint>& sources = scene.meshes[placed.mesh].bake_points;
    for (std::size_t i = 0; i < sources.size(); ++i)
      points_[first_point_[piece] + i] = {
          Vec3f(placed.world_from_mesh * (Vec3(sources[i].position) * placed.scale)),
          Vec3f(placed.world_from_mesh.rotation.rotate(Vec3(sources[i].normal)))};
  }
}

void LampBounce::cast_map(const Vec3f& from) {
  rays_.follow();
  parallel_for(kSide, threads_, [&](std::size_t y) {
    std::array<RayScene::Ray, kSide> rays;
    std::array<RayScene::PreciseHit, kSide> hits;
    for (int x = 0; x < kSide; ++x) rays[std::size_t(x)] = {from, 0, direction_of(x, int(y)), kReach};
    rays_.cast_many(rays.data(), rays.size(), RayScene::Order::coherent, hits.data());
    for (std::size_t x = 0; x < kSide; ++x)
      map_[y * kSide + x] = hits[x].triangle == RayScene::kNone ? kReach : hits[x].distance;
  });
}

float LampBounce::distance_towards(const Vec3f& d) const {
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
bool LampBounce::may_see(const PlacedMesh& piece, const PlacedLamp& lamp) const {
  const Vec3f way = piece.centre - lamp.position;
  const float away = norm(way);
  if (away - piece.radius > kReach) return false;
  // A piece that fills more than a few directions may stick out somewhere.
  if (away < 12 * piece.radius) return true;
  return away - piece.radius < distance_towards(way * (1 / away)) * (1 + kSlack) + kNear;
}

void LampBounce::light_points(const PlacedLamp& lamp) {
  seen_.clear();
  for (std::uint32_t piece = 0; piece < scene_.placed.size(); ++piece)
    if (first_point_[piece] != kNoPoints && may_see(scene_.placed[piece], lamp)) seen_.push_back(piece);
  std::fill(radiance_.begin(), radiance_.end(), Vec3f());
  parallel_for(seen_.size(), threads_, [&](std::size_t k) {
    const std::uint32_t piece = seen_[k];
    const std::size_t first = first_point_[piece];
    const std::size_t count = scene_.meshes[scene_.placed[piece].mesh].bake_points.size();
    for (std::size_t i = first; i < first + count; ++i) {
      const Vec3f way = points_[i].position - lamp.position;
      const float facing = -dot(points_[i].normal, way), away2 = dot(way, way);
      if (facing <= 0 || away2 > kReach * kReach || away2 < 1e-6f) continue;
      const float away = std::sqrt(away2);
      if (away > distance_towards(way) * (1 + kSlack) + kNear) continue;
      const float kept = kept_at(away) * std::exp(-extinction_ * away) * facing / (away * portable::kPiF);
      radiance_[i] = multiply(links_.albedos[i], lamp.illuminance(lamp.position, points_[i].position)) * kept;
    }
  });
}

// last: with the direction; before, every other ray will do.
LampBounce::Arrived LampBounce::gather(std::size_t point, bool last) const {
  const std::uint32_t* links = links_.seen.data() + point * BakeLinks::kPerPoint;
  Arrived out;
  int rays = 0;
  for (std::size_t k = 0; k < BakeLinks::kPerPoint; k += last ? 1 : 2) {
    if (links[k] == BakeLinks::kNoRay) continue;
    ++rays;
    if (links[k] == BakeLinks::kDark) continue;
    const Vec3f& light = radiance_[links[k]];
    if (light.y <= 0) continue;
    out.colour += light;
    if (!last) continue;
    const Vec3f way = points_[links[k]].position - points_[point].position;
    const Vec3f w = way * (1 / std::max(norm(way), 1e-4f));
    out.vector += w * (luminance(light) / std::max(dot(w, points_[point].normal), 0.35f));
  }
  const float scale = rays > 0 ? portable::kPiF / float(rays) : 0;
  out.colour *= scale;
  out.vector = out.vector * scale + points_[point].normal * (luminance(out.colour) - dot(out.vector, points_[point].normal) * scale);
  return out;
}

void LampBounce::pass_on(const Vec3f& lamp) {
  const auto over_seen = [&](const auto& work) {
    parallel_for(seen_.size(), threads_, [&](std::size_t k) {
      const std::size_t first = first_point_[seen_[k]];
      const std::size_t count = scene_.meshes[scene_.placed[seen_[k]].mesh].bake_points.size();
      for (std::size_t i = first; i < first + count; ++i) work(i);
    });
  };
  const auto kept = [&](std::size_t i) { return kept_at(distance(points_[i].position, lamp)); };
  over_seen([&](std::size_t i) { arrived_[i] = kept(i) > 0 ? gather(i, false) : Arrived(); });
  // What comes back of light that was thrown back once: the mean over all light, in order, so that the
  // number of threads does not matter.
  double before = 0, after = 0;
  for (const std::uint32_t piece : seen_) {
    const std::size_t first = first_point_[piece];
    const std::size_t count = scene_.meshes[scene_.placed[piece].mesh].bake_points.size();
    for (std::size_t i = first; i < first + count; ++i) {
      before += double(luminance(radiance_[i]));
      after += double(luminance(multiply(links_.albedos[i], arrived_[i].colour))) / portable::kPi;
    }
  }
  const float again = before > 0 ? std::min(float(after / before), kMostAgain) : 0;
  over_seen([&](std::size_t i) {
    radiance_[i] += multiply(links_.albedos[i], arrived_[i].colour) * (1 / (portable::kPiF * (1 - again)));
  });
  over_seen([&](std::size_t i) {
    if (kept(i) <= 0) return;  // dark already
    arrived_[i] = gather(i, true);
    arrived_[i].colour *= kept(i), arrived_[i].vector *= kept(i);
  });
}

void LampBounce::add_to_nodes(std::size_t piece, const std::vector<BakedLight>& base) {
  const PlacedMesh& placed = scene_.placed[piece];
  const std::vector<LightNode>& nodes = scene_.meshes[placed.mesh].light_nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    Vec3f colour, vector;
    for (std::size_t k = 0; k < 4; ++k) {
      const Arrived& a = arrived_[first_point_[piece] + nodes[i].points[k]];
      colour += a.colour * nodes[i].weights[k], vector += a.vector * nodes[i].weights[k];
    }
    if (colour.y <= 0) continue;
    const Vec3f n(placed.world_from_mesh.rotation.rotate(Vec3(nodes[i].normal)));
    BakedLight& out = out_[placed.first_light + i];
    const UnpackedLight there = unpack_light(base[placed.first_light + i], n);
    out = pack_light(there.vector + vector, there.colour + colour);
  }
}

const std::vector<BakedLight>& LampBounce::add_to(const std::vector<BakedLight>& base, const PlacedLamp& lamp,
                                                  float extinction) {
  extinction_ = extinction;
  cast_map(lamp.position);
  light_points(lamp);
  pass_on(lamp.position);
  out_ = base;
  parallel_for(seen_.size(), threads_, [&](std::size_t k) { add_to_nodes(seen_[k], base); });
  return out_;
}

}  // namespace rubble
