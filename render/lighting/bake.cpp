#include "render/lighting/bake.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kernel/base/parallel.h"
#include "kernel/base/portable_math.h"
#include "kernel/base/random.h"
#include "render/geometry/ray_scene.h"
#include "render/lighting/bake_air.h"
#include "render/lighting/light_packing.h"
#include "render/lighting/reflected_light.h"
#include "render/materials/surface_appearance.h"
#include "render/materials/tile_noise.h"

namespace rubble {

namespace {

constexpr float kPi = float(portable::kPi);
constexpr std::uint32_t kSky = 0xffffffffu, kInside = 0xfffffffeu, kNone = 0xffffffffu;
constexpr float kLift = 0.004f;               // rays start this far off the surface; unit: m
constexpr float kFarthest = 1000.0f;          // unit: m
constexpr float kDarkest = 1e-4f;             // unit: klx
constexpr float kMaxInside = 0.3f;            // share of rays that start inside a neighbour
constexpr std::size_t kChunk = 256;           // points a job
constexpr float kContact = 0.3f;              // light left where pieces touch
constexpr std::size_t kMostForSearch = 4000;  // bake points; the ground has more
constexpr float kSmoothing = 0.5f;            // reach, as a share of the piece's radius
constexpr float kWidestSmoothing = 0.35f;     // unit: m

struct Point {
  Vec3f position, normal;
};

// Directions for one point: spread evenly, cosine-weighted about +Z (Malley's method over a
// golden-ratio sequence).
std::vector<Vec3f> cosine_directions(int count) {
  std::vector<Vec3f> out;
  for (int i = 0; i < count; ++i) {
    const double u = (i + 0.5) / count, turn = i * 0.6180339887498949;
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

BakedScene open_sky_light(const PreparedScene& scene, const LightSet& light) {
  // An even dome gives pi L to a level face, half that to a wall.
  const Vec3f radiance = light.sky.mean;
  BakedScene out;
  out.air.size = {1, 1, 1};
  out.air.radiance = {radiance * 0.5f};
  out.vertices.reserve(scene.light_vertices);
  for (const PlacedMesh& piece : scene.placed) {
    for (const PreparedVertex& v : scene.meshes[piece.mesh].vertices) {
      const Vec3f n(piece.world_from_mesh.rotation.rotate(Vec3(v.normal)));
      const float e = kPi * luminance(radiance) * (0.55f + 0.45f * n.z);
      out.vertices.push_back(pack_light(n * e, radiance));
    }
  }
  return out;
}

namespace {

// The pieces as a ray caster sees them, with the light on them.
struct Baker {
  Baker(const PreparedScene& s, const LightSet& l, const BakeOptions& o)
      : scene(s), light(l), options(o), rays(s), directions(cosine_directions(o.rays)) {}

  const PreparedScene& scene;
  LightSet light;
  BakeOptions options;
  RayScene rays;
  std::vector<Vec3f> directions;
  std::vector<Point> points;                  // of all placed meshes
  std::vector<std::uint32_t> first_point;     // of each placed mesh
  std::vector<std::uint32_t> triangle_point;  // nearest bake point of each triangle of `rays`
  std::vector<Vec3f> triangle_albedo;
  std::vector<std::uint32_t> hits;              // rays a point: triangle, kSky or kInside
  std::vector<std::uint8_t> valid;              // one a point
  std::vector<std::uint32_t> open_point;        // for an invalid point: where its light comes from
  std::vector<Vec3f> direct, indirect, vector;  // one a point; klx
  std::vector<Vec3f> radiosity;                 // one a triangle of `rays`, over pi: kcd/m2

  void run(const std::function<void(double)>& progress);
  std::vector<BakedLight> vertex_light() const;

  struct Basis {
    Vec3f x, y, z;
    Vec3f operator*(const Vec3f& d) const { return x * d.x + y * d.y + z * d.z; }
  };
  void list_points();
  void list_triangles();
  Basis basis_of(std::size_t point) const;  // its directions about its normal
  void trace(std::size_t point);
  void gather(std::size_t point);
  void update_radiosity();
  void darken_invalid();
  void find_open_points();
  void smooth_ground(std::size_t piece, std::vector<Vec3f>& colours,
                     std::vector<Vec3f>& vectors) const;
  void smooth(std::size_t piece, std::vector<Vec3f>& colours, std::vector<Vec3f>& vectors) const;
};

void Baker::list_points() {
  for (const PlacedMesh& piece : scene.placed) {
    first_point.push_back(std::uint32_t(points.size()));
    for (const BakePoint& p : scene.meshes[piece.mesh].bake_points)
      points.push_back({Vec3f(piece.world_from_mesh * (Vec3(p.position) * piece.scale)),
                        Vec3f(piece.world_from_mesh.rotation.rotate(Vec3(p.normal)))});
  }
  hits.resize(points.size() * std::size_t(options.rays));
  valid.assign(points.size(), 1);
  direct.resize(points.size());
  indirect.resize(points.size());
  vector.resize(points.size());
}

void Baker::list_triangles() {
  const std::vector<SurfaceAppearance>& looks = all_surface_appearances();
  for (const RayScene::Triangle& t : rays.triangles()) {
    const PreparedMesh& mesh = scene.meshes[scene.placed[t.placed].mesh];
    const PreparedTriangle& source = mesh.triangles[t.source];
    triangle_point.push_back(first_point[t.placed] +
                             mesh.vertices[source.vertices[0]].bake_points[0]);
    triangle_albedo.push_back(mean_albedo(looks[source.material]));
  }
  radiosity.resize(triangle_point.size());
}

Baker::Basis Baker::basis_of(std::size_t point) const {
  Basis basis;
  basis.z = points[point].normal;
  const float turn = lattice_value(int(point), int(point >> 31), std::uint32_t(options.seed));
  basis_about(basis.z, turn, basis.x, basis.y);
  return basis;
}

void Baker::trace(std::size_t i) {
  const Point& p = points[i];
  const Vec3f from = p.position + p.normal * kLift;
  const std::size_t count = directions.size();
  std::size_t inside = 0;
  const Basis basis = basis_of(i);
  for (std::size_t r = 0; r < count; ++r) {
    const RayScene::Hit hit = rays.cast(from, basis * directions[r], 0.0005f, kFarthest);
    std::uint32_t code = hit.triangle == RayScene::kNone ? kSky : hit.triangle;
    if (hit.triangle != RayScene::kNone && hit.back) code = kInside, ++inside;
    hits[i * count + r] = code;
  }
  valid[i] = float(inside) <= kMaxInside * float(count);
  direct[i] = Vec3f();
  for (const LightModel& l : light.lights) {
    const LightModel::Sample sample = l.at(p.position);
    const float facing = dot(sample.to_light, p.normal);
    const bool lit = valid[i] && facing > 0 && luminance(sample.illuminance) > 0 &&
                     !rays.blocked(from + p.normal * 0.01f, sample.to_light, 0.001f,
                                   std::min(sample.distance * 0.999f, kFarthest));
    if (lit) direct[i] += sample.illuminance * facing;
  }
}

// Illuminance E = pi / N sum L, and the vector V with E(n') = dot(n', V) for normals near n:
// V = pi / N sum L w / (n.w), its length kept in check where w grazes the surface.
void Baker::gather(std::size_t i) {
  Vec3f sum, direction;
  const std::size_t count = directions.size();
  const Basis basis = basis_of(i);
  for (std::size_t r = 0; r < count; ++r) {
    const std::uint32_t code = hits[i * count + r];
    if (code == kInside) continue;
    const Vec3f w = basis * directions[r];
    const Vec3f l = code == kSky ? paler(light.sky.radiance(w)) : radiosity[code];
    sum += l;
    direction += w * (luminance(l) / std::max(directions[r].z, 0.35f));
  }
  const float scale = kPi / float(count);
  indirect[i] = sum * scale;
  const float along = dot(direction, points[i].normal) * scale;
  const float want = luminance(indirect[i]);
  // Exact for the vertex's own normal whatever the clamping did.
  vector[i] = direction * scale + points[i].normal * (want - along);
}

void Baker::update_radiosity() {
  for (std::size_t t = 0; t < radiosity.size(); ++t) {
    const std::uint32_t p = triangle_point[t];
    radiosity[t] = multiply(triangle_albedo[t], direct[p] + indirect[p]) * (1 / kPi);
  }
}

// A point inside a neighbour takes a part of what the nearest open point of its own piece and side
// gets: it is dark around a contact.
void Baker::darken_invalid() {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (valid[i]) continue;
    const bool lit = open_point[i] != kNone;
    indirect[i] = lit ? indirect[open_point[i]] * kContact : Vec3f();
    vector[i] = points[i].normal * luminance(indirect[i]);
  }
}

void Baker::find_open_points() {
  open_point.assign(points.size(), kNone);
  parallel_for(scene.placed.size(), options.threads, [&](std::size_t piece) {
    const std::size_t first = first_point[piece];
    const std::size_t count = scene.meshes[scene.placed[piece].mesh].bake_points.size();
    if (count > kMostForSearch) return;
    for (std::size_t i = first; i < first + count; ++i) {
      float nearest = 1e30f;
      for (std::size_t k = first; k < first + count && !valid[i]; ++k) {
        const Vec3f d = points[k].position - points[i].position;
        if (!valid[k] || dot(points[k].normal, points[i].normal) < 0.7f) continue;
        if (dot(d, d) < nearest) nearest = dot(d, d), open_point[i] = std::uint32_t(k);
      }
    }
  });
}

// Few rays leave noise from point to point: each takes in those around it on the same side.
void Baker::smooth(std::size_t piece, std::vector<Vec3f>& colours,
                          std::vector<Vec3f>& vectors) const {
  const std::size_t first = first_point[piece];
  const std::size_t count = scene.meshes[scene.placed[piece].mesh].bake_points.size();
  if (scene.placed[piece].id == kGroundId || count > kMostForSearch) return;
  const float reach = kSmoothing * scene.placed[piece].radius;
  const float limit = std::min(reach * reach, kWidestSmoothing * kWidestSmoothing);
  for (std::size_t i = first; i < first + count; ++i) {
    if (!valid[i]) continue;
    Vec3f colour, vector_sum;
    float sum = 0;
    for (std::size_t k = first; k < first + count; ++k) {
      const Vec3f d = points[k].position - points[i].position;
      const float facing = dot(points[k].normal, points[i].normal);
      const float near = 1 - dot(d, d) / limit;
      if (!valid[k] || near <= 0 || facing < 0.7f) continue;
      colour += indirect[k] * near, vector_sum += vector[k] * near, sum += near;
    }
    colours[i] = colour * (1 / sum), vectors[i] = vector_sum * (1 / sum);
  }
}

// The ground is a grid: each point takes in those about it that it has a free line to, so that
// light does not creep under walls.
void Baker::smooth_ground(std::size_t piece, std::vector<Vec3f>& colours,
                          std::vector<Vec3f>& vectors) const {
  constexpr float kReach = 0.75f, kHeight = 0.03f;  // unit: m
  const std::size_t first = first_point[piece];
  const std::size_t count = scene.meshes[scene.placed[piece].mesh].bake_points.size();
  std::size_t row = 1;
  while (row < count && points[first + row].position.y == points[first].position.y) ++row;
  const Vec3f up(0, 0, kHeight);
  parallel_for(count / row, options.threads, [&](std::size_t j) {
    for (std::size_t c = 0; c < row; ++c) {
      const std::size_t i = first + j * row + c;
      if (!valid[i]) continue;
      Vec3f colour = indirect[i], vector_sum = vector[i];
      float sum = 1;
      for (std::size_t y = j > 2 ? j - 2 : 0; y <= std::min(j + 2, count / row - 1); ++y) {
        for (std::size_t x = c > 2 ? c - 2 : 0; x <= std::min(c + 2, row - 1); ++x) {
          const std::size_t k = first + y * row + x;
          const Vec3f d = points[k].position - points[i].position;
          const float away = norm(d), near = 1 - away / kReach;
          if (k == i || !valid[k] || near <= 0) continue;
          if (rays.blocked(points[i].position + up, d * (1 / away), 0, away)) continue;
          colour += indirect[k] * near, vector_sum += vector[k] * near, sum += near;
        }
      }
      colours[i] = colour * (1 / sum), vectors[i] = vector_sum * (1 / sum);
    }
  });
}

void Baker::run(const std::function<void(double)>& progress) {
  list_points();
  list_triangles();
  const std::size_t jobs = (points.size() + kChunk - 1) / kChunk;
  const auto over_points = [&](std::size_t first_job, std::size_t last_job, auto&& work) {
    parallel_for(last_job - first_job, options.threads, [&](std::size_t job) {
      const std::size_t first = (first_job + job) * kChunk;
      for (std::size_t i = first; i < std::min(first + kChunk, points.size()); ++i) work(i);
    });
  };
  constexpr std::size_t kSlice = 64;  // jobs between two reports
  for (std::size_t job = 0; job < jobs; job += kSlice) {
    over_points(job, std::min(job + kSlice, jobs), [&](std::size_t i) { trace(i); });
    if (progress) progress(0.8 * double(std::min(job + kSlice, jobs)) / double(jobs));
  }
  find_open_points();
  for (int bounce = 0; bounce < options.bounces; ++bounce) {
    update_radiosity();
    over_points(0, jobs, [&](std::size_t i) { gather(i); });
    darken_invalid();
  }
  std::vector<Vec3f> colours = indirect, vectors = vector;
  parallel_for(scene.placed.size(), options.threads,
               [&](std::size_t piece) { smooth(piece, colours, vectors); });
  for (std::size_t i = 0; i < scene.placed.size(); ++i)
    if (scene.placed[i].id == kGroundId) smooth_ground(i, colours, vectors);
  indirect.swap(colours), vector.swap(vectors);
  update_radiosity();
  hits.clear();
  hits.shrink_to_fit();
  if (progress) progress(0.9);
}

std::vector<BakedLight> Baker::vertex_light() const {
  std::vector<BakedLight> out(scene.light_vertices);
  parallel_for(scene.placed.size(), options.threads, [&](std::size_t i) {
    const PlacedMesh& piece = scene.placed[i];
    const PreparedMesh& mesh = scene.meshes[piece.mesh];
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      // Directions and colours are mixed as they are; brightness as its logarithm, so that one
      // bright point behind an edge does not outshine three dark ones.
      Vec3f along, colour;
      float logarithm = 0, mean = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        const float w = mesh.vertices[v].bake_weights[k];
        const std::size_t p = first_point[i] + mesh.vertices[v].bake_points[k];
        const float bright = luminance(indirect[p]);
        along += vector[p] * w;
        colour += indirect[p] * w;
        mean += w * bright;
        logarithm += w * std::log2(bright + kDarkest);
      }
      if (mean > 0) along *= std::exp2(logarithm) / (mean + kDarkest);
      out[piece.first_light + v] = pack_light(along, colour);
    }
  });
  return out;
}

}  // namespace

BakedScene bake_light(const PreparedScene& scene, const LightSet& light,
                      const BakeOptions& options, const std::function<void(double)>& progress) {
  Baker baker(scene, light, options);
  baker.run(progress);
  BakedScene out{baker.vertex_light(),
                 bake_air({scene, baker.light, baker.rays, baker.radiosity, options.threads})};
  if (progress) progress(1);
  return out;
}

}  // namespace rubble
