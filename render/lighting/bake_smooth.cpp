// What points of a bake take from their neighbours: less noise, and light for those inside a piece; and what
// they see of each other.
#include <algorithm>
#include <cmath>

#include "kernel/base/parallel.h"
#include "render/geometry/point_grid.h"
#include "render/lighting/baker.h"
#include "render/lighting/reflected_light.h"

namespace rubble {

namespace {

constexpr float kReach = 0.5f;       // of smoothing, as a share of the point's clearance
constexpr float kWidest = 0.3f;      // unit: m
constexpr float kFacing = 0.85f;     // least cosine between the normals of neighbours
constexpr float kLift = 0.01f;       // of lines of sight between them; unit: m
constexpr float kCell = 0.15f;       // of space; unit: m
constexpr float kSearch = 0.35f;     // for a point that is inside a piece; unit: m
constexpr float kContact = 0.7f;     // light left where pieces touch

}  // namespace

// Light varies over a distance that grows with that of what sends it (Ward et al. 1988): so far, and no
// farther than a free line of sight, a neighbour's light is as good as the point's own.
void Baker::smooth(std::size_t piece, std::vector<Point>& out) const {
  const std::size_t first = first_point_[piece];
  const std::size_t count = scene_.meshes[scene_.placed[piece].mesh].bake_points.size();
  PointGrid grid(kCell);
  for (std::size_t i = first; i < first + count; ++i) grid.add(points_[i].position, std::uint32_t(i));
  for (std::size_t i = first; i < first + count; ++i) {
    const Point& p = points_[i];
    const float reach = std::min(kReach * p.clearance, kWidest);
    if (!p.open || reach < 0.02f) continue;
    Vec3f indirect = p.indirect, vector = p.vector;
    float sum = 1;
    grid.near(p.position, int(std::ceil(reach / kCell)), [&](std::uint32_t k) {
      const Point& q = points_[k];
      const Vec3f d = q.position - p.position;
      const float away2 = dot(d, d), near = 1 - away2 / (reach * reach);
      if (k == i || !q.open || near <= 0 || dot(p.normal, q.normal) < kFacing) return;
      const float away = std::sqrt(std::max(away2, 1e-12f));
      const Vec3f from = p.position + p.normal * kLift;
      if (rays_.blocked(from, (d + (q.normal - p.normal) * kLift) * (1 / away), 0, away)) return;
      indirect += q.indirect * near, vector += q.vector * near, sum += near;
    });
    out[i].indirect = indirect * (1 / sum), out[i].vector = vector * (1 / sum);
  }
}

// A point inside a neighbour takes a part of what an open point of its own piece and side has nearby: the
// darkest, so that light does not creep under walls.
void Baker::find_substitutes() {
  substitutes_.assign(points_.size(), kNone);
  parallel_for(scene_.placed.size(), options_.threads, [&](std::size_t piece) {
    const std::size_t first = first_point_[piece];
    const std::size_t count = scene_.meshes[scene_.placed[piece].mesh].bake_points.size();
    PointGrid grid(kCell);
    for (std::size_t i = first; i < first + count; ++i)
      if (points_[i].open) grid.add(points_[i].position, std::uint32_t(i));
    for (std::size_t i = first; i < first + count; ++i) {
      if (points_[i].open) continue;
      float nearest = kSearch;
      grid.near(points_[i].position, 2, [&](std::uint32_t k) {
        const float away = distance(points_[k].position, points_[i].position);
        if (dot(points_[k].normal, points_[i].normal) < 0.7f || away >= nearest) return;
        nearest = away, substitutes_[i] = k;
      });
    }
  });
}

void Baker::fill_closed() {
  for (std::size_t i = 0; i < points_.size(); ++i) {
    Point& p = points_[i];
    if (p.open) continue;
    const bool lit = substitutes_[i] != kNone;
    p.indirect = lit ? points_[substitutes_[i]].indirect * kContact : Vec3f();
    p.vector = p.normal * luminance(p.indirect);
  }
}

// A node's nearest point stands for it, or what stands in for that where it is inside a piece; a point's
// albedo is the mean of the nodes it stands for.
BakeLinks Baker::links() const {
  std::vector<std::uint32_t> point_of(scene_.light_nodes);
  std::vector<int> count(points_.size(), 0);
  BakeLinks out;
  out.albedos.resize(points_.size());
  for (std::size_t piece = 0; piece < scene_.placed.size(); ++piece) {
    const PlacedMesh& placed = scene_.placed[piece];
    const std::vector<LightNode>& nodes = scene_.meshes[placed.mesh].light_nodes;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const auto& w = nodes[i].weights;
      const auto best = std::size_t(std::max_element(w.begin(), w.end()) - w.begin());
      const std::uint32_t p = first_point_[piece] + nodes[i].points[best];
      point_of[placed.first_light + i] = p;
      out.albedos[p] += albedos_[placed.first_light + i], ++count[p];
    }
  }
  for (std::size_t i = 0; i < count.size(); ++i)
    if (count[i]) out.albedos[i] *= 1 / float(count[i]);
  const auto open_point = [&](std::uint32_t p) {
    return points_[p].open ? p : substitutes_[p] != kNone ? substitutes_[p] : BakeLinks::kDark;
  };
  const std::size_t rays = first_directions_.size();
  out.seen.assign(points_.size() * BakeLinks::kPerPoint, BakeLinks::kNoRay);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const std::size_t origins = origin_count(points_[i]);
    for (std::size_t k = 0; k < std::min(BakeLinks::kPerPoint, rays); ++k) {
      const std::size_t r = k * rays / std::min(BakeLinks::kPerPoint, rays);
      const std::uint32_t code = first_hits_[i * rays + r];
      if (!(points_[i].open >> (r % origins) & 1u)) continue;
      out.seen[i * BakeLinks::kPerPoint + k] =
          code == kSky || code == kInside ? BakeLinks::kDark : open_point(point_of[code]);
    }
  }
  for (std::size_t i = 0; i < points_.size(); ++i)
    if (!points_[i].open && substitutes_[i] != kNone)
      std::copy_n(out.seen.begin() + std::ptrdiff_t(substitutes_[i] * BakeLinks::kPerPoint), BakeLinks::kPerPoint,
                  out.seen.begin() + std::ptrdiff_t(i * BakeLinks::kPerPoint));
  return out;
}

}  // namespace rubble
