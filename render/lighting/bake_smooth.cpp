// What points of a bake take from their neighbours: less noise, and light for those inside a piece.
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

}  // namespace

// Light varies over a distance that grows with that of what is seen (Ward et al. 1988): so far, and no farther than a
// free line of sight, a neighbour's light is as good as the point's own. What is dark counts less, so this is the
// geometric mean of the distances of all that is seen and of what sends the light.
float Baker::reach_of(const Point& p, float light_distance) const {
  const float away = std::sqrt(p.clearance * std::max(p.clearance, light_distance));
  const float reach = std::min(kReach * away, kWidest * (scene_.placed[p.piece].surrounds ? kAround : 1));
  return p.open && reach >= kLeastReach ? reach : 0;
}

std::vector<PointCells::Point> Baker::open_points(std::uint32_t first, std::uint32_t end) const {
  std::vector<PointCells::Point> out;
  for (std::uint32_t i = first; i < end; ++i)
    if (points_[i].open) out.push_back({places_[i].position, i});
  return out;
}

// Looks at those after it alone: each line of sight is cast once, for both of its ends.
void Baker::join_neighbours(std::uint32_t i, const PointCells& grid, Piece& piece, std::vector<RayScene::Ray>& lines) const {
  const BakePlace& p = places_[i];
  const auto reach = [&](std::uint32_t point) { return reach_of(points_[point], piece.of(point).light_distance); };
  const float reach_of_p = reach(i);
  std::vector<std::uint32_t> ends;
  lines.clear();
  grid.near(p.position, int(std::ceil(kWidest / kCell)), [&](std::uint32_t k) {
    const BakePlace& q = places_[k];
    const Vec3f d = q.position - p.position;
    const float away2 = dot(d, d);
    if (k <= i || dot(p.normal, q.normal) < kFacing) return;
    const float farthest = std::max(reach_of_p, reach(k));
    if (away2 >= farthest * farthest) return;
    const float away = std::sqrt(std::max(away2, 1e-12f));
    lines.push_back({p.position + p.normal * kLift, 0, (d + (q.normal - p.normal) * kLift) * (1 / away), away});
    ends.push_back(k);
  });
  std::vector<std::uint8_t> hidden(lines.size());
  rays_->blocked_many(lines.data(), lines.size(), RayScene::Order::coherent, hidden.data());
  const auto take = [&](std::uint32_t of, std::uint32_t from, float away) {
    const float farthest = reach(of);
    if (away < farthest) piece.of(of).neighbours.push_back({from, 1 - away * away / (farthest * farthest)});
  };
  for (std::size_t n = 0; n < lines.size(); ++n)
    if (!hidden[n]) take(i, ends[n], lines[n].farthest), take(ends[n], i, lines[n].farthest);
}

void Baker::find_neighbours(Piece& piece) const {
  const PointCells grid(kCell * (scene_.placed[piece.number].surrounds ? kAround : 1), open_points(piece.first, piece.end));
  std::vector<RayScene::Ray> lines;
  for (std::uint32_t i = piece.first; i < piece.end; ++i)
    if (points_[i].open) join_neighbours(i, grid, piece, lines);
  for (Found& found : piece.found) {
    float sum = 1, squares = 1;
    for (const Neighbour& n : found.neighbours) sum += n.weight, squares += n.weight * n.weight;
    found.noise_left = squares / (sum * sum);
  }
}

// The direct light of far lights, which is not smoothed, comes to no pixel but by the nodes.
void Baker::smooth(Piece& piece) const {
  std::vector<Arrived> out;
  for (std::uint32_t i = piece.first; i < piece.end; ++i) {
    Arrived mean = piece.of(i).arrived;
    float sum = 1;
    for (const Neighbour& n : piece.of(i).neighbours) {
      mean.indirect += piece.of(n.point).arrived.indirect * n.weight;
      mean.vector += piece.of(n.point).arrived.vector * n.weight;
      sum += n.weight;
    }
    mean.indirect = mean.indirect * (1 / sum), mean.vector = mean.vector * (1 / sum);
    if (!far_light_.empty()) mean.indirect += far_light_[i], mean.vector += far_vectors_[i];
    out.push_back(mean);
  }
  for (std::uint32_t i = piece.first; i < piece.end; ++i) {
    Arrived& arrived = piece.of(i).arrived;
    arrived = out[i - piece.first];
    if (points_[i].open) continue;
    arrived.indirect = substitutes_[i] != kNone ? out[substitutes_[i] - piece.first].indirect * kContact : Vec3f();
    arrived.vector = places_[i].normal * luminance(arrived.indirect);
  }
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
      grid.near(places_[i].position, 2, [&](std::uint32_t k) {
        const float away = distance(places_[k].position, places_[i].position);
        if (dot(places_[k].normal, places_[i].normal) < 0.7f || away >= nearest) return;
        nearest = away, substitutes_[i] = k;
      });
    }
  });
}

}  // namespace rubble
