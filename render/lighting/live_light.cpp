#include "render/lighting/live_light.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/portable_math.h"
#include "render/lighting/reflected_light.h"

namespace rubble {

namespace {

constexpr int kDirections = 32;       // rays a probe
constexpr double kMostProbes = 4000;  // about
constexpr std::size_t kAlbedoTriangles = 200;  // about; of a mesh, that its albedo is looked up at
constexpr double kLeastCell = 0.4;    // unit: m
constexpr double kMargin = 0.8;       // around what moves; unit: m
constexpr float kLowest = 0.05f;      // of a probe above the ground; unit: m
constexpr float kBuried = 0.35f;      // share of rays that start inside a piece
constexpr float kDimmer = 0.6f;       // a probe inside a piece, against its neighbours outside
constexpr float kTrust = 0.02f;       // weight of such a probe against one outside
constexpr float kOff = 0.5f;          // light is looked up so far off a surface; unit: a cell

// Evenly over the sphere, by a golden-ratio sequence.
std::vector<Vec3f> sphere_directions() {
  std::vector<Vec3f> out;
  for (int i = 0; i < kDirections; ++i) {
    const double z = 1 - (2 * i + 1.0) / kDirections, turn = i * 0.6180339887498949;
    const portable::SinCos a = portable::sincos(2 * portable::kPi * (turn - std::floor(turn)));
    const double r = std::sqrt(1 - z * z);
    out.push_back({float(r * a.cos), float(r * a.sin), float(z)});
  }
  return out;
}

}  // namespace

// Radiance from direction w: mean + (slope[0] w.x + slope[1] w.y + slope[2] w.z); unit: kcd/m2
struct LiveLight::Probe {
  Vec3f mean, slope[3];
  bool inside = false;  // of a piece
  bool known = true;    // or filled in

  void add(const Probe& other, float weight) {
    mean += other.mean * weight;
    for (int i = 0; i < 3; ++i) slope[i] += other.slope[i] * weight;
  }
  // Illuminance of a surface of normal n: pi mean + 2/3 pi slope n (Ramamoorthi and Hanrahan 2001).
  Vec3f illuminance(const Vec3f& n) const {
    const Vec3f along = slope[0] * n.x + slope[1] * n.y + slope[2] * n.z;
    return max(mean * portable::kPiF + along * (2 * portable::kPiF / 3), Vec3f());
  }
  // dot(n, result) is the strength of that light, for normals near n.
  Vec3f vector(const Vec3f& n) const {
    const Vec3f rise = Vec3f(luminance(slope[0]), luminance(slope[1]), luminance(slope[2])) *
                       (2 * portable::kPiF / 3);
    return n * (luminance(illuminance(n)) - dot(rise, n)) + rise;
  }
};

// What a ray from a probe meets.
struct LiveLight::Hit {
  enum Kind : std::uint8_t { sky, surface, inside } kind = sky;
  Vec3f point, normal, albedo;
  Vec3f direct;  // of the lights on the surface; unit: klx
};

LiveLight::LiveLight(const PreparedScene& scene, const LightSet& light,
                     std::vector<BakedLight> resting, const AlbedoAt& albedo, int threads)
    : scene_(scene),
      light_(light),
      threads_(threads),
      rays_(scene),
      directions_(sphere_directions()),
      resting_(std::move(resting)),
      out_(resting_) {
  find_albedos(albedo);
  lay_out_grid();
  without_ = solve();
}

// As drawn, at a few places of each triangle; of meshes with many triangles of every second or so.
void LiveLight::find_albedos(const AlbedoAt& albedo) {
  std::vector<double> areas(all_surface_appearances().size(), 0);
  albedos_.assign(areas.size(), {});
  for (std::uint32_t piece = 0; piece < scene_.placed.size(); ++piece) {
    const PreparedMesh& mesh = scene_.meshes[scene_.placed[piece].mesh];
    const std::size_t stride = 1 + mesh.triangles.size() / kAlbedoTriangles;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); t += std::uint32_t(stride)) {
      const PreparedTriangle& triangle = mesh.triangles[t];
      const Vec3f& p0 = mesh.vertices[triangle.vertices[0]].position;
      const float area = norm(cross(mesh.vertices[triangle.vertices[1]].position - p0,
                                    mesh.vertices[triangle.vertices[2]].position - p0));
      for (const auto& [u, v] : {std::pair(0.2f, 0.2f), {0.6f, 0.2f}, {0.2f, 0.6f}, {0.33f, 0.33f}})
        albedos_[triangle.material] += albedo({piece, t}, u, v) * (area / 4);
      areas[triangle.material] += double(area);
    }
  }
  for (std::size_t i = 0; i < areas.size(); ++i)
    if (areas[i] > 0) albedos_[i] *= float(1 / areas[i]);
}

LiveLight::~LiveLight() = default;

void LiveLight::lay_out_grid() {
  Aabb box = scene_.bounds;
  if (box.empty()) box.include({0, 0, 1});
  const Vec3 margin(kMargin, kMargin, kMargin);
  box.min -= margin, box.max += margin;
  box.min.z = std::max(box.min.z, double(kLowest));
  box.max.z = std::max(box.max.z, box.min.z + kLeastCell);
  const Vec3 edges = box.max - box.min;
  const double cell = std::max(kLeastCell, std::cbrt(edges.x * edges.y * edges.z / kMostProbes));
  origin_ = Vec3f(box.min);
  for (int i = 0; i < 3; ++i) {
    size_[i] = std::max(2, int(std::ceil(edges[i] / cell)) + 1);
    cell_[i] = float(edges[i] / (size_[i] - 1));
  }
}

Vec3f LiveLight::point_of(std::size_t probe) const {
  const auto nx = std::size_t(size_[0]), ny = std::size_t(size_[1]);
  const Vec3f step(float(probe % nx), float(probe / nx % ny), float(probe / (nx * ny)));
  return origin_ + multiply(cell_, step);
}

LiveLight::Grid LiveLight::solve() {
  rays_.follow();
  const std::size_t count = std::size_t(size_[0]) * std::size_t(size_[1]) * std::size_t(size_[2]);
  const std::size_t row = std::size_t(size_[0]);
  std::vector<Hit> hits(count * kDirections);
  Grid first(count), second(count);
  parallel_for(count / row, threads_, [&](std::size_t job) {
    for (std::size_t i = job * row; i < (job + 1) * row; ++i) {
      trace(i, hits);
      first[i] = gather(hits, i * kDirections, nullptr);
    }
  });
  fill_inside(first);
  parallel_for(count / row, threads_, [&](std::size_t job) {
    for (std::size_t i = job * row; i < (job + 1) * row; ++i)
      second[i] = gather(hits, i * kDirections, &first);
  });
  fill_inside(second);
  return second;
}

void LiveLight::trace(std::size_t probe, std::vector<Hit>& hits) const {
  const Vec3f from = point_of(probe);
  for (std::size_t r = 0; r < directions_.size(); ++r) {
    const RayScene::Hit met = rays_.cast(from, directions_[r], 0, kLightReach);
    Hit& hit = hits[probe * kDirections + r];
    hit.kind = met.triangle == RayScene::kNone ? Hit::sky : met.back ? Hit::inside : Hit::surface;
    if (hit.kind != Hit::surface) continue;
    const RayScene::Triangle& triangle = rays_.triangles()[met.triangle];
    const PlacedMesh& piece = scene_.placed[triangle.placed];
    const PreparedMesh& mesh = scene_.meshes[piece.mesh];
    const PreparedTriangle& source = mesh.triangles[triangle.source];
    const Vec3f p0 = mesh.vertices[source.vertices[0]].position;
    const Vec3f area = cross(mesh.vertices[source.vertices[1]].position - p0,
                             mesh.vertices[source.vertices[2]].position - p0);
    hit.normal = normalized(Vec3f(piece.world_from_mesh.rotation.rotate(Vec3(area))));
    hit.point = from + directions_[r] * met.distance + hit.normal * 0.01f;
    hit.albedo = albedos_[source.material];
    hit.direct = light_of(hit);
  }
}

Vec3f LiveLight::light_of(const Hit& hit) const {
  Vec3f sum;
  for (const LightModel& light : light_.lights) {
    const LightModel::Sample sample = light.at(hit.point);
    const float facing = dot(sample.to_light, hit.normal);
    if (facing <= 0 || luminance(sample.illuminance) <= 0) continue;
    const float reach = std::min(sample.distance * 0.999f, kLightReach);
    if (!rays_.blocked(hit.point, sample.to_light, 0.001f, reach)) sum += sample.illuminance * facing;
  }
  return sum;
}

// Projection on the first four spherical harmonics: slope = 3 mean(L w). lit: what lights the surfaces
// besides the lights; null: nothing does.
LiveLight::Probe LiveLight::gather(const std::vector<Hit>& hits, std::size_t first,
                                   const Grid* lit) const {
  Probe probe;
  int inside = 0;
  for (std::size_t r = 0; r < directions_.size(); ++r) {
    const Hit& hit = hits[first + r];
    const Vec3f& w = directions_[r];
    Vec3f radiance;
    if (hit.kind == Hit::sky) {
      radiance = light_.sky.radiance(w);
    } else if (hit.kind == Hit::surface) {
      Vec3f e = hit.direct;
      if (lit) e += sample(*lit, hit.point + multiply(cell_, hit.normal) * kOff).illuminance(hit.normal);
      radiance = multiply(hit.albedo, e) * (1 / portable::kPiF);
    } else {
      ++inside;
    }
    probe.mean += radiance;
    for (int i = 0; i < 3; ++i) probe.slope[i] += radiance * w[i];
  }
  const float share = 1.0f / float(directions_.size());
  probe.mean *= share;
  for (Vec3f& slope : probe.slope) slope *= 3 * share;
  probe.inside = float(inside) > kBuried * float(directions_.size());
  probe.known = !probe.inside;
  return probe;
}

// Inside pieces: what their neighbours outside have, ring by ring, ever darker.
void LiveLight::fill_inside(Grid& grid) const {
  const std::ptrdiff_t nx = size_[0], ny = size_[1];
  const std::ptrdiff_t steps[6] = {-1, 1, -nx, nx, -nx * ny, nx * ny};
  for (bool changed = true; changed;) {
    changed = false;
    const Grid before = grid;
    for (std::size_t i = 0; i < grid.size(); ++i) {
      if (before[i].known) continue;
      const int x = int(i) % size_[0], y = int(i) / size_[0] % size_[1];
      const int z = int(i) / (size_[0] * size_[1]);
      const bool there[6] = {x > 0, x + 1 < size_[0], y > 0, y + 1 < size_[1], z > 0, z + 1 < size_[2]};
      Probe sum;
      float count = 0;
      for (int k = 0; k < 6; ++k) {
        const auto j = std::size_t(std::ptrdiff_t(i) + steps[k]);
        if (there[k] && before[j].known) sum.add(before[j], 1), count += 1;
      }
      if (count == 0) continue;
      grid[i] = Probe();
      grid[i].inside = true;
      grid[i].add(sum, kDimmer / count);
      changed = true;
    }
  }
}

bool LiveLight::covers(const Vec3f& point) const {
  for (int i = 0; i < 3; ++i) {
    const float at = (point[i] - origin_[i]) / cell_[i];
    if (at < -1 || at > float(size_[i])) return false;
  }
  return true;
}

LiveLight::Probe LiveLight::sample(const Grid& grid, const Vec3f& point) const {
  int low[3];
  float part[3];
  for (int i = 0; i < 3; ++i) {
    const float most = float(size_[i] - 1);
    const float at = std::clamp((point[i] - origin_[i]) / cell_[i], 0.0f, most);
    low[i] = std::min(int(at), size_[i] - 2);
    part[i] = at - float(low[i]);
  }
  Probe out;
  float sum = 0;
  for (int k = 0; k < 8; ++k) {
    const int x = low[0] + (k & 1), y = low[1] + (k >> 1 & 1), z = low[2] + (k >> 2);
    const float weight = (k & 1 ? part[0] : 1 - part[0]) * (k & 2 ? part[1] : 1 - part[1]) *
                         (k & 4 ? part[2] : 1 - part[2]);
    if (weight <= 0) continue;
    const Probe& probe = grid[std::size_t((z * size_[1] + y) * size_[0] + x)];
    const float trust = probe.inside ? weight * kTrust : weight;
    out.add(probe, trust);
    sum += trust;
  }
  Probe mean;
  mean.add(out, 1 / sum);
  return mean;
}

void LiveLight::light_moving(const PlacedMesh& piece) {
  const PreparedMesh& mesh = scene_.meshes[piece.mesh];
  struct Point {
    Vec3f vector, colour;
  };
  std::vector<Point> points;
  points.reserve(mesh.bake_points.size());
  for (const BakePoint& p : mesh.bake_points) {
    const Vec3f at(piece.world_from_mesh * (Vec3(p.position) * piece.scale));
    const Vec3f n(piece.world_from_mesh.rotation.rotate(Vec3(p.normal)));
    const Probe probe = sample(now_, at + multiply(cell_, n) * kOff);
    points.push_back({probe.vector(n), probe.illuminance(n)});
  }
  for (std::size_t v = 0; v < mesh.light_nodes.size(); ++v) {
    Vec3f vector, colour;
    for (std::size_t k = 0; k < 4; ++k) {
      const float weight = mesh.light_nodes[v].weights[k];
      const Point& p = points[mesh.light_nodes[v].points[k]];
      vector += p.vector * weight, colour += p.colour * weight;
    }
    out_[piece.first_light + v] = pack_light(vector, colour);
  }
}

void LiveLight::light_resting(const PlacedMesh& piece) {
  const PreparedMesh& mesh = scene_.meshes[piece.mesh];
  for (std::size_t v = 0; v < mesh.light_nodes.size(); ++v) {
    const Vec3f at(piece.world_from_mesh * (Vec3(mesh.light_nodes[v].position) * piece.scale));
    if (!covers(at)) continue;
    const Vec3f n(piece.world_from_mesh.rotation.rotate(Vec3(mesh.light_nodes[v].normal)));
    const Vec3f near = at + multiply(cell_, n) * kOff;
    const float before = luminance(sample(without_, near).illuminance(n));
    const float now = luminance(sample(now_, near).illuminance(n));
    if (now >= before) continue;
    const float kept = now / before;
    const BakedLight& baked = resting_[piece.first_light + v];
    BakedLight& out = out_[piece.first_light + v];
    out.x = to_half(from_half(baked.x) * kept);
    out.y = to_half(from_half(baked.y) * kept);
    out.z = to_half(from_half(baked.z) * kept);
  }
}

const std::vector<BakedLight>& LiveLight::update() {
  now_ = solve();
  out_ = resting_;
  parallel_for(scene_.placed.size(), threads_, [&](std::size_t i) {
    const PlacedMesh& piece = scene_.placed[i];
    if (!piece.there) return;
    if (piece.moves)
      light_moving(piece);
    else
      light_resting(piece);
  });
  return out_;
}

}  // namespace rubble
