#include "render/lighting/baker.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/parallel.h"
#include "kernel/base/portable_math.h"
#include "render/lighting/light_packing.h"
#include "render/lighting/reflected_light.h"
#include "render/materials/tile_noise.h"

namespace rubble {

namespace {

constexpr std::size_t kFirstRays = 48;        // a point, that are kept
constexpr int kRound = 64;                    // rays between two looks at the noise
constexpr float kNoise = 0.04f;               // standard error at which a point has enough rays
constexpr float kLift = 0.002f;               // rays start this far off the surface; unit: m
constexpr float kMostInside = 0.3f;           // share of rays that may meet a piece from inside
constexpr std::size_t kChunk = 256;           // points a job
constexpr float kSunSine = 0.00465f;          // radius of the sun's disc; unit: rad

// Directions spread evenly, cosine-weighted about +Z (Malley's method over a golden-ratio sequence).
std::vector<Vec3f> cosine_directions(std::size_t count) {
  std::vector<Vec3f> out;
  for (std::size_t i = 0; i < count; ++i) {
    const double u = (double(i) + 0.5) / double(count), turn = double(i) * 0.6180339887498949;
    const portable::SinCos a = portable::sincos(2 * portable::kPi * (turn - std::floor(turn)));
    const double r = std::sqrt(u);
    out.push_back({float(r * a.cos), float(r * a.sin), float(std::sqrt(1 - u))});
  }
  return out;
}

void basis_about(const Vec3f& n, float turn, Vec3f& x, Vec3f& y) {
  const Vec3f side = std::fabs(n.z) < 0.9f ? Vec3f(0, 0, 1) : Vec3f(1, 0, 0);
  const Vec3f a = normalized(cross(side, n)), b = cross(n, a);
  const portable::SinCos t = portable::sincos(2 * portable::kPi * double(turn));
  x = a * float(t.cos) + b * float(t.sin);
  y = b * float(t.cos) - a * float(t.sin);
}

}  // namespace

// What the rays of a point say.
struct Baker::Sum {
  Vec3f light, direction;  // of radiance; and of directions by its strength
  float bright2 = 0;       // of squares of strengths
  float near = 0;          // of reciprocal distances
  int rays = 0;

  // cosine: of the ray with the normal.
  void add(const Vec3f& radiance, const Vec3f& w, float cosine, float distance) {
    const float bright = luminance(radiance);
    light += radiance, bright2 += bright * bright;
    direction += w * (bright / std::max(cosine, 0.35f));
    near += distance < kLightReach ? 1 / std::max(distance, 0.01f) : 0;
    ++rays;
  }
  bool quiet() const {
    const float n = float(rays), mean = luminance(light) / n;
    // Directions that are spread evenly have about half the noise of chance.
    return 0.5f * std::sqrt(std::max(bright2 / n - mean * mean, 0.0f) / n) < kNoise * mean;
  }
  // Illuminance E = pi / N sum L, and the vector V with E(n') = dot(n', V) for normals near n: V = pi / N
  // sum L w / (n.w), its length kept in check where w grazes the surface.
  void finish(Point& p) const {
    const float scale = portable::kPiF / float(std::max(rays, 1));
    p.indirect = light * scale;
    p.vector = direction * scale + p.normal * (luminance(p.indirect) - dot(direction, p.normal) * scale);
    p.clearance = near > 0 ? float(rays) / near : kLightReach;
  }
};

Baker::Baker(const PreparedScene& scene, const LightSet& light, const AlbedoAt& albedo, const BakeOptions& options)
    : scene_(scene),
      light_(light),
      options_(options),
      rays_(scene, RayScene::Detail::finest),
      first_directions_(cosine_directions(std::min(kFirstRays, std::size_t(options.rays)))),
      directions_(cosine_directions(std::size_t(std::min(kRound, options.rays)))) {
  list_points();
  find_albedos(albedo);
}

void Baker::list_points() {
  for (std::size_t piece = 0; piece < scene_.placed.size(); ++piece) {
    const PlacedMesh& placed = scene_.placed[piece];
    const std::vector<BakePoint>& sources = scene_.meshes[placed.mesh].bake_points;
    first_point_.push_back(std::uint32_t(points_.size()));
    for (std::size_t i = 0; i < sources.size(); ++i) {
      Point p;
      p.position = Vec3f(placed.world_from_mesh * (Vec3(sources[i].position) * placed.scale));
      p.normal = Vec3f(placed.world_from_mesh.rotation.rotate(Vec3(sources[i].normal)));
      p.piece = std::uint32_t(piece), p.source = std::uint32_t(i);
      points_.push_back(p);
    }
  }
  first_hits_.resize(points_.size() * first_directions_.size());
  radiance_.resize(scene_.light_nodes);
}

void Baker::find_albedos(const AlbedoAt& albedo) {
  albedos_.resize(scene_.light_nodes);
  parallel_for(scene_.placed.size(), options_.threads, [&](std::size_t piece) {
    const PlacedMesh& placed = scene_.placed[piece];
    const std::vector<LightNode>& nodes = scene_.meshes[placed.mesh].light_nodes;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      albedos_[placed.first_light + i] =
          albedo({std::uint32_t(piece), nodes[i].triangle}, nodes[i].u, nodes[i].v);
  });
}

Baker::Basis Baker::basis_of(std::size_t point, std::uint32_t round) const {
  Basis basis;
  basis.z = points_[point].normal;
  const float turn = lattice_value(int(point), int(round), std::uint32_t(options_.seed));
  basis_about(basis.z, turn, basis.x, basis.y);
  return basis;
}

std::size_t Baker::origin_count(const Point& p) const {
  return scene_.meshes[scene_.placed[p.piece].mesh].bake_points[p.source].origin_count;
}

BakeOrigin Baker::origin(const Point& p, std::size_t i) const {
  const PlacedMesh& placed = scene_.placed[p.piece];
  const PreparedMesh& mesh = scene_.meshes[placed.mesh];
  const BakeOrigin& source = mesh.bake_origins[mesh.bake_points[p.source].first_origin + i];
  const Vec3f normal(placed.world_from_mesh.rotation.rotate(Vec3(source.normal)));
  return {Vec3f(placed.world_from_mesh * (Vec3(source.position) * placed.scale)) + normal * kLift, normal};
}

std::uint32_t Baker::nearest_node(const RayScene::PreciseHit& hit) const {
  const RayScene::Triangle& t = rays_.triangles()[hit.triangle];
  const PlacedMesh& placed = scene_.placed[t.placed];
  const LightNodes nodes = find_light_nodes(scene_.meshes[placed.mesh], t.source, hit.u, hit.v);
  const std::size_t best = std::size_t(std::max_element(nodes.weight.begin(), nodes.weight.end()) - nodes.weight.begin());
  return placed.first_light + nodes.node[best];
}

Vec3f Baker::light_met(const RayScene::PreciseHit& hit) const {
  const RayScene::Triangle& t = rays_.triangles()[hit.triangle];
  const PlacedMesh& placed = scene_.placed[t.placed];
  const LightNodes nodes = find_light_nodes(scene_.meshes[placed.mesh], t.source, hit.u, hit.v);
  Vec3f sum;
  for (std::size_t k = 0; k < 3; ++k) sum += radiance_[placed.first_light + nodes.node[k]] * nodes.weight[k];
  return sum;
}

// Which of its origins are inside a piece shows in what their rays meet.
void Baker::trace(std::size_t i) {
  Point& p = points_[i];
  const std::size_t count = first_directions_.size(), origins = origin_count(p);
  const Basis basis = basis_of(i, 0);
  std::array<int, 8> rays{}, inside{};
  for (std::size_t r = 0; r < count; ++r) {
    const std::size_t o = r % origins;
    const RayScene::Ray ray{origin(p, o).position, 0, basis * first_directions_[r], kLightReach};
    RayScene::PreciseHit hit;
    rays_.cast_many(&ray, 1, RayScene::Order::scattered, &hit);
    const bool open = hit.triangle == RayScene::kNone;
    first_hits_[i * count + r] = open ? kSky : hit.back ? kInside : nearest_node(hit);
    ++rays[o], inside[o] += !open && hit.back;
  }
  for (std::size_t o = 0; o < origins; ++o)
    if (float(inside[o]) <= kMostInside * float(rays[o])) p.open = std::uint8_t(p.open | 1u << o);
  find_direct(p);
}

// The mean over the origins outside all pieces, each from another spot of the sun's disc.
void Baker::find_direct(Point& p) const {
  int open = 0;
  Vec3f sum;
  for (std::size_t o = 0; o < origin_count(p); ++o) {
    if (!(p.open >> o & 1u)) continue;
    ++open;
    const BakeOrigin from = origin(p, o);
    for (const LightModel& l : light_.lights) {
      const LightModel::Sample sample = l.at(from.position);
      Vec3f to_light = sample.to_light, x, y;
      if (l.type == LightType::directional) {
        basis_about(to_light, float(o) * 0.618034f, x, y);
        to_light = normalized(to_light + x * (kSunSine * std::sqrt((float(o) + 0.5f) / 8)));
      }
      const float facing = dot(to_light, from.normal);
      if (facing <= 0 || luminance(sample.illuminance) <= 0) continue;
      if (!rays_.blocked(from.position, to_light, 0, std::min(sample.distance * 0.999f, kLightReach)))
        sum += sample.illuminance * facing;
    }
  }
  p.direct = open ? sum * (1 / float(open)) : Vec3f();
}

void Baker::gather_first(std::size_t i) {
  Point& p = points_[i];
  const std::size_t count = first_directions_.size(), origins = origin_count(p);
  const Basis basis = basis_of(i, 0);
  Sum sum;
  for (std::size_t r = 0; r < count; ++r) {
    const std::uint32_t code = first_hits_[i * count + r];
    if (!(p.open >> (r % origins) & 1u)) continue;
    const Vec3f w = basis * first_directions_[r];
    const Vec3f l = code == kSky ? light_.sky.radiance(w) : code == kInside ? Vec3f() : radiance_[code];
    sum.add(l, w, first_directions_[r].z, kLightReach);
  }
  sum.finish(p);
}

void Baker::add_round(std::size_t i, std::uint32_t round, Sum& sum) const {
  const Point& p = points_[i];
  std::array<Vec3f, 8> from;
  std::size_t origins = 0;
  for (std::size_t o = 0; o < origin_count(p); ++o)
    if (p.open >> o & 1u) from[origins++] = origin(p, o).position;
  const Basis basis = basis_of(i, round);
  for (std::size_t r = 0; r < directions_.size(); ++r) {
    const Vec3f w = basis * directions_[r];
    const RayScene::Ray ray{from[(r + round) % origins], 0, w, kLightReach};
    RayScene::PreciseHit hit;
    rays_.cast_many(&ray, 1, RayScene::Order::scattered, &hit);
    const bool open = hit.triangle == RayScene::kNone;
    const Vec3f l = open ? light_.sky.radiance(w) : hit.back ? Vec3f() : light_met(hit);
    sum.add(l, w, directions_[r].z, open ? kLightReach : hit.distance);
  }
}

void Baker::gather(std::size_t i) {
  if (!points_[i].open) return;
  Sum sum;
  for (std::uint32_t round = 1; sum.rays < options_.rays; ++round) {
    add_round(i, round, sum);
    if (round > 1 && sum.quiet()) break;
  }
  sum.finish(points_[i]);
}

Vec3f Baker::mixed(std::size_t piece, const LightNode& node, Vec3f Point::*what) const {
  Vec3f sum;
  for (std::size_t k = 0; k < 4; ++k) sum += points_[first_point_[piece] + node.points[k]].*what * node.weights[k];
  return sum;
}

void Baker::update_radiance() {
  parallel_for(scene_.placed.size(), options_.threads, [&](std::size_t piece) {
    const PlacedMesh& placed = scene_.placed[piece];
    const std::vector<LightNode>& nodes = scene_.meshes[placed.mesh].light_nodes;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const Vec3f light = mixed(piece, nodes[i], &Point::direct) + mixed(piece, nodes[i], &Point::indirect);
      radiance_[placed.first_light + i] = multiply(albedos_[placed.first_light + i], light) * (1 / portable::kPiF);
    }
  });
}

template <typename Work>
void Baker::over_points(double from, double to, const std::function<void(double)>& progress, const Work& work) {
  constexpr std::size_t kSlice = 64;  // jobs between two reports
  const std::size_t jobs = (points_.size() + kChunk - 1) / kChunk;
  for (std::size_t first = 0; first < jobs; first += kSlice) {
    const std::size_t last = std::min(first + kSlice, jobs);
    parallel_for(last - first, options_.threads, [&](std::size_t job) {
      const std::size_t begin = (first + job) * kChunk;
      for (std::size_t i = begin; i < std::min(begin + kChunk, points_.size()); ++i) work(i);
    });
    if (progress) progress(from + (to - from) * double(last) / double(jobs));
  }
}

void Baker::run(const std::function<void(double)>& progress) {
  over_points(0, 0.2, progress, [&](std::size_t i) { trace(i); });
  find_substitutes();
  for (int bounce = 0; bounce < options_.bounces; ++bounce) {
    update_radiance();
    over_points(0.2, 0.2, progress, [&](std::size_t i) { gather_first(i); });
    fill_closed();
  }
  update_radiance();
  over_points(0.2, 0.85, progress, [&](std::size_t i) { gather(i); });
  std::vector<Point> smoothed = points_;
  parallel_for(scene_.placed.size(), options_.threads, [&](std::size_t piece) { smooth(piece, smoothed); });
  points_.swap(smoothed);
  fill_closed();
  update_radiance();
  if (progress) progress(0.9);
}

std::vector<BakedLight> Baker::node_light() const {
  std::vector<BakedLight> out(scene_.light_nodes);
  parallel_for(scene_.placed.size(), options_.threads, [&](std::size_t piece) {
    const PlacedMesh& placed = scene_.placed[piece];
    const std::vector<LightNode>& nodes = scene_.meshes[placed.mesh].light_nodes;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      out[placed.first_light + i] =
          pack_light(mixed(piece, nodes[i], &Point::vector), mixed(piece, nodes[i], &Point::indirect));
  });
  return out;
}

std::vector<Vec3f> Baker::triangle_radiance() const {
  std::vector<Vec3f> out;
  out.reserve(rays_.triangles().size());
  for (const RayScene::Triangle& t : rays_.triangles()) {
    const PlacedMesh& placed = scene_.placed[t.placed];
    const auto& corners = scene_.meshes[placed.mesh].triangles[t.source].vertices;
    Vec3f sum;
    for (const std::uint32_t v : corners) sum += radiance_[placed.first_light + v] * (1.0f / 3);
    out.push_back(sum);
  }
  return out;
}

}  // namespace rubble
