#include "render/media/air_links.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kernel/base/parallel.h"
#include "kernel/base/portable_math.h"
#include "render/lighting/lighting.h"
#include "render/media/corner_sight.h"

namespace rubble {

namespace {

constexpr float kCell = 0.4f;           // unit: m
constexpr std::size_t kMost = 2500;    // points
constexpr float kLowest = 0.05f;        // above the ground; unit: m

std::vector<Vec3f> even_directions() {
  std::vector<Vec3f> out;
  for (std::size_t i = 0; i < AirLinks::kDirections; ++i) {
    const double z = 1 - (2 * double(i) + 1) / AirLinks::kDirections, turn = double(i) * 0.6180339887498949;
    const portable::SinCos a = portable::sincos(2 * portable::kPi * (turn - std::floor(turn)));
    const double r = std::sqrt(1 - z * z);
    out.push_back({float(r * a.cos), float(r * a.sin), float(z)});
  }
  return out;
}

AirGrid make_grid(const Aabb& box, bool above_ground) {
  AirGrid grid;
  grid.origin = Vec3f(box.min);
  if (above_ground) grid.origin.z = std::max(grid.origin.z, kLowest);
  for (float cell = kCell;; cell *= 1.1f) {
    for (int i = 0; i < 3; ++i) {
      const float length = std::max(float(box.max[i]) - grid.origin[i], 0.1f);
      grid.size[std::size_t(i)] = std::max(int(std::ceil(length / cell)) + 1, 2);
      grid.cell[i] = length / float(grid.size[std::size_t(i)] - 1);
    }
    if (grid.count() <= kMost) return grid;
  }
}

class LinkMaker {
 public:
  LinkMaker(const PreparedScene& scene, const RayScene& rays, AirLinks& links)
      : scene_(scene), rays_(rays), links_(links) {
    std::uint32_t next = 0;
    for (const PlacedMesh& piece : scene.placed) {
      first_point_.push_back(next);
      next += std::uint32_t(scene.meshes[piece.mesh].bake_points.size());
    }
  }
  void make(int threads);

 private:
  std::uint32_t point_of(const RayScene::PreciseHit& hit) const;
  bool look_around(std::size_t i);
  std::uint32_t find_hidden(std::size_t i) const;
  void look_along(std::size_t i, const CornerSight& sight, std::vector<std::uint8_t>& seen);
  void find_nearest(const std::vector<std::uint8_t>& open);

  const PreparedScene& scene_;
  const RayScene& rays_;
  AirLinks& links_;
  std::vector<std::uint32_t> first_point_;
};

// The heaviest point of the node that weighs most there.
std::uint32_t LinkMaker::point_of(const RayScene::PreciseHit& hit) const {
  const RayScene::Triangle t = rays_.triangle(hit.triangle);
  const PreparedMesh& mesh = scene_.meshes[scene_.placed[t.placed].mesh];
  const LightNodes nodes = find_light_nodes(mesh, t.source, hit.u, hit.v);
  const auto heaviest = [](const auto& w) { return std::size_t(std::max_element(w.begin(), w.end()) - w.begin()); };
  const LightNode& node = mesh.light_nodes[nodes.node[heaviest(nodes.weight)]];
  return first_point_[t.placed] + node.points[heaviest(node.weights)];
}

// False where the point lies inside a piece.
bool LinkMaker::look_around(std::size_t i) {
  const Vec3f from = links_.grid.point(i);
  std::array<RayScene::Ray, AirLinks::kDirections> rays;
  std::array<RayScene::PreciseHit, AirLinks::kDirections> hits;
  for (std::size_t k = 0; k < rays.size(); ++k) rays[k] = {from, 0, links_.directions[k], kLightReach};
  rays_.cast_many(rays.data(), rays.size(), RayScene::Order::scattered, hits.data());
  std::size_t inside = 0;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    AirLinks::End& end = links_.ends[k * links_.grid.count() + i];
    end = {hits[k].distance, AirLinks::kDark};
    if (hits[k].triangle == RayScene::kNone)
      end = {kLightReach, AirLinks::kSky};
    else if (hits[k].back)
      ++inside;
    else
      end.point = point_of(hits[k]);
  }
  return inside <= AirLinks::kDirections / 4;
}

std::uint32_t LinkMaker::find_hidden(std::size_t i) const {
  const Vec3f from = links_.grid.point(i);
  std::uint32_t bits = 0;
  for (int k = 0; k < 27; ++k) {
    const std::size_t j = links_.neighbour(i, k);
    if (j == i) continue;
    const Vec3f way = links_.grid.point(j) - from;
    const float length = norm(way);
    if (rays_.blocked(from, way * (1 / length), 0, length)) bits |= 1u << k;
  }
  return bits;
}

// For all places of the links of a point. What a link meets lies within a stretch, or beyond the box, where nothing is asked.
void LinkMaker::look_along(std::size_t i, const CornerSight& sight, std::vector<std::uint8_t>& seen) {
  const Vec3f from = links_.grid.point(i);
  for (std::size_t k = 0; k < AirLinks::kDirections; ++k) {
    links_.first_place[i * AirLinks::kDirections + k] = std::uint32_t(seen.size());
    const Vec3f& d = links_.directions[k];
    const float length = links_.length(k, i);
    links_.cut(length, [&](float middle, float) { seen.push_back(sight.seen_from(from + d * middle)); });
    const bool meets = links_.ends[k * links_.grid.count() + i].distance <= length;
    seen.push_back(meets ? sight.seen_from(from + d * links_.place_before_end(length)) : 255);
  }
}

// Ring by ring.
void LinkMaker::find_nearest(const std::vector<std::uint8_t>& open) {
  std::vector<std::uint8_t> known = open;
  for (bool changed = true; changed;) {
    changed = false;
    const std::vector<std::uint8_t> before = known;
    for (std::size_t i = 0; i < known.size(); ++i) {
      for (const int place : {4, 10, 12, 14, 16, 22}) {
        const std::size_t j = links_.neighbour(i, place);
        if (known[i] || !before[j]) continue;
        links_.nearest[i] = links_.nearest[j], known[i] = 1, changed = true;
      }
    }
  }
}

void LinkMaker::make(int threads) {
  const std::size_t count = links_.grid.count();
  links_.ends.resize(count * AirLinks::kDirections);
  links_.nearest.resize(count), links_.hidden.resize(count);
  links_.first_place.resize(count * AirLinks::kDirections);
  std::vector<std::uint8_t> open(count);
  const CornerSight sight(scene_, rays_, links_.grid);
  constexpr std::size_t kChunk = 64;
  const std::size_t jobs = (count + kChunk - 1) / kChunk;
  std::vector<std::vector<std::uint8_t>> seen(jobs);
  parallel_for(jobs, threads, [&](std::size_t job) {
    for (std::size_t i = job * kChunk; i < std::min(count, (job + 1) * kChunk); ++i) {
      links_.nearest[i] = std::uint32_t(i);
      open[i] = look_around(i);
      if (!open[i]) continue;
      links_.hidden[i] = find_hidden(i);
      look_along(i, sight, seen[job]);
    }
  });
  for (std::size_t job = 0; job < jobs; ++job) {
    const std::size_t end = std::min(count, (job + 1) * kChunk) * AirLinks::kDirections;
    for (std::size_t n = job * kChunk * AirLinks::kDirections; n < end; ++n)
      links_.first_place[n] += std::uint32_t(links_.seen.size());
    links_.seen.insert(links_.seen.end(), seen[job].begin(), seen[job].end());
  }
  find_nearest(open);
}

}  // namespace

std::size_t AirLinks::neighbour(std::size_t i, int place) const {
  const auto nx = std::size_t(grid.size[0]), ny = std::size_t(grid.size[1]), nz = std::size_t(grid.size[2]);
  const std::size_t x = i % nx + std::size_t(place % 3), y = i / nx % ny + std::size_t(place / 3 % 3);
  const std::size_t z = i / (nx * ny) + std::size_t(place / 9);  // each one too many
  if (x < 1 || y < 1 || z < 1 || x > nx || y > ny || z > nz) return i;
  return ((z - 1) * ny + y - 1) * nx + x - 1;
}

float AirLinks::length(std::size_t direction, std::size_t point) const {
  const Vec3f d = directions[direction], from = grid.point(point) - grid.origin, box = grid.length();
  float border = kLightReach;
  for (int a = 0; a < 3; ++a)
    if (std::fabs(d[a]) > 1e-6f) border = std::min(border, (d[a] > 0 ? box[a] - from[a] : -from[a]) / d[a]);
  return std::max(std::min(ends[direction * grid.count() + point].distance, border), 0.0f);
}

AirLinks make_air_links(const PreparedScene& scene, const RayScene& rays, const Aabb& box, int threads) {
  AirLinks links;
  links.grid = make_grid(box, std::any_of(scene.placed.begin(), scene.placed.end(),
                                          [](const PlacedMesh& piece) { return piece.id == kGroundId; }));
  links.directions = even_directions();
  LinkMaker(scene, rays, links).make(threads);
  return links;
}

AirMatter turning_matter(const Air& air, const AirGrid& grid) {
  AirMatter out;
  const double fog_g = air.fog_asymmetry(), drops_g = Precipitation::kAsymmetry;
  for (std::size_t i = 0; i < grid.count(); ++i) {
    const double fog = air.fog(Vec3(grid.point(i))), drops = air.drops();
    const double all = fog * air.turned_share(fog_g) + drops * air.turned_share(drops_g);
    out.extinction.push_back(float(all));
    std::array<float, kOrders>& scattered = out.scattered.emplace_back();
    if (all <= 0) continue;
    double of_fog = air.albedo() * fog * (1 - forward_share(fog_g)) / all;
    double of_drops = air.albedo() * drops * (1 - forward_share(drops_g)) / all;
    for (float& order : scattered) {
      order = float(of_fog + of_drops);
      of_fog *= turned_cosine(fog_g), of_drops *= turned_cosine(drops_g);
    }
  }
  return out;
}

}  // namespace rubble
