// What points of a bake take from their neighbours: less noise, and light for those inside a piece; and what
// they see of each other.
#include <algorithm>
#include <cmath>

#include "kernel/base/parallel.h"
#include "render/geometry/point_cells.h"
#include "render/lighting/baker.h"
#include "render/lighting/reflected_light.h"

namespace rubble {

namespace {

constexpr float kReach = 0.5f;       // of smoothing, as a share of the distance of what is seen
constexpr float kWidest = 0.3f;      // unit: m
constexpr float kAround = 8;         // times as wide, and its cells, on surroundings, where points are sparse
constexpr float kLeastReach = 0.02f; // below, a point keeps what it found; unit: m
constexpr float kFacing = 0.85f;     // least cosine between the normals of neighbours
constexpr float kLift = 0.01f;       // of lines of sight between them; unit: m
constexpr float kCell = 0.15f;       // of space; unit: m
constexpr float kSearch = 0.35f;     // for a point that is inside a piece; unit: m
constexpr float kContact = 0.7f;     // light left where pieces touch

}  // namespace

// Light varies over a distance that grows with that of what is seen (Ward et al. 1988): so far, and no farther than a
// free line of sight, a neighbour's light is as good as the point's own. What is dark counts less, so this is the
// geometric mean of the distances of all that is seen and of what sends the light.
float Baker::reach_of(const Point& p) const {
  const float away = std::sqrt(p.clearance * std::max(p.clearance, p.light_distance));
  const float reach = std::min(kReach * away, kWidest * (scene_.placed[p.piece].surrounds ? kAround : 1));
  return p.open && reach >= kLeastReach ? reach : 0;
}

std::vector<PointCells::Point> Baker::open_points(std::uint32_t first, std::uint32_t end) const {
  std::vector<PointCells::Point> out;
  for (std::uint32_t i = first; i < end; ++i)
    if (points_[i].open) out.push_back({points_[i].position, i});
  return out;
}

// Looks at those after it alone: each line of sight is cast once, for both of its ends.
void Baker::join_neighbours(std::uint32_t i, const PointCells& grid, std::vector<RayScene::Ray>& lines) {
  const Point& p = points_[i];
  const float reach_of_p = reach_of(p);
  std::vector<std::uint32_t> ends;
  lines.clear();
  grid.near(p.position, int(std::ceil(kWidest / kCell)), [&](std::uint32_t k) {
    const Point& q = points_[k];
    const Vec3f d = q.position - p.position;
    const float away2 = dot(d, d);
    if (k <= i || dot(p.normal, q.normal) < kFacing) return;
    const float reach = std::max(reach_of_p, reach_of(q));
    if (away2 >= reach * reach) return;
    const float away = std::sqrt(std::max(away2, 1e-12f));
    lines.push_back({p.position + p.normal * kLift, 0, (d + (q.normal - p.normal) * kLift) * (1 / away), away});
    ends.push_back(k);
  });
  std::vector<std::uint8_t> hidden(lines.size());
  rays_.blocked_many(lines.data(), lines.size(), RayScene::Order::coherent, hidden.data());
  const auto take = [&](std::uint32_t of, std::uint32_t from, float away) {
    const float reach = reach_of(points_[of]);
    if (away < reach) neighbours_[of].push_back({from, 1 - away * away / (reach * reach)});
  };
  for (std::size_t n = 0; n < lines.size(); ++n)
    if (!hidden[n]) take(i, ends[n], lines[n].farthest), take(ends[n], i, lines[n].farthest);
}

void Baker::find_neighbours(std::size_t piece) {
  const std::uint32_t first = first_point_[piece], end = std::uint32_t(end_point(piece));
  const PointCells grid(kCell * (scene_.placed[piece].surrounds ? kAround : 1), open_points(first, end));
  std::vector<RayScene::Ray> lines;
  for (std::uint32_t i = first; i < end; ++i)
    if (points_[i].open) join_neighbours(i, grid, lines);
  for (std::uint32_t i = first; i < end; ++i) {
    float sum = 1, squares = 1;
    for (const Neighbour& n : neighbours_[i]) sum += n.weight, squares += n.weight * n.weight;
    points_[i].noise_left = squares / (sum * sum);
  }
}

void Baker::smooth(std::size_t i, Point& out) const {
  Vec3f indirect = points_[i].indirect, vector = points_[i].vector;
  float sum = 1;
  for (const Neighbour& n : neighbours_[i]) {
    indirect += points_[n.point].indirect * n.weight, vector += points_[n.point].vector * n.weight;
    sum += n.weight;
  }
  out.indirect = indirect * (1 / sum), out.vector = vector * (1 / sum);
}

// A point inside a neighbour takes a part of what an open point of its own piece and side has nearby: the
// darkest, so that light does not creep under walls.
void Baker::find_substitutes() {
  substitutes_.assign(points_.size(), kNone);
  parallel_for(scene_.placed.size(), options_.threads, [&](std::size_t piece) {
    const std::uint32_t first = first_point_[piece], end = std::uint32_t(end_point(piece));
    const PointCells grid(kCell, open_points(first, end));
    for (std::uint32_t i = first; i < end; ++i) {
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

// By a part of the first rays; where one meets a point inside a piece, what stands in for that is seen.
BakeLinks Baker::links() const {
  BakeLinks out;
  out.albedos = albedos_, out.radiance = radiance_;
  const auto open_point = [&](std::uint32_t p) {
    return points_[p].open ? p : substitutes_[p] != kNone ? substitutes_[p] : BakeLinks::kDark;
  };
  const std::size_t rays = first_spokes_.size(), kept = std::min(BakeLinks::kPerPoint, rays);
  out.seen.assign(points_.size() * BakeLinks::kPerPoint, BakeLinks::kNoRay);
  for (std::size_t i = 0; i < points_.size(); ++i)
    for (std::size_t k = 0; k < kept; ++k) {
      const std::uint32_t code = first_hits_[i * rays + k * rays / kept];
      if (code == kNone) continue;
      out.seen[i * BakeLinks::kPerPoint + k] = code == kSky || code == kInside ? BakeLinks::kDark : open_point(code);
    }
  for (std::size_t i = 0; i < points_.size(); ++i)
    if (!points_[i].open && substitutes_[i] != kNone)
      std::copy_n(out.seen.begin() + std::ptrdiff_t(substitutes_[i] * BakeLinks::kPerPoint), BakeLinks::kPerPoint,
                  out.seen.begin() + std::ptrdiff_t(i * BakeLinks::kPerPoint));
  return out;
}

}  // namespace rubble
