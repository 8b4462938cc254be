#include "render/lighting/live_light.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/portable_math.h"
#include "render/lighting/reflected_light.h"

namespace rubble {

namespace {

constexpr int kDirections = 32;       // rays a probe
constexpr std::size_t kAlbedoTriangles = 200;  // about; of a mesh, that its albedo is looked up at
constexpr double kMargin = 0.8;       // around what moves; unit: m
constexpr float kLowest = 0.05f;      // of a probe above the ground; unit: m
constexpr float kBuried = 0.35f;      // share of rays that start inside a piece
constexpr std::size_t kMostMovers = 200;  // with more, all rays are cast again
constexpr float kAway = 0.002f;       // a ray this far from a sphere passes it by; unit: m
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

// What a ray from a probe meets.
struct LiveLight::Hit {
  enum Kind : std::uint8_t { sky, surface, inside } kind = sky;
  float distance = kLightReach;  // unit: m
  Vec3f point, normal, albedo;
  Vec3f direct;  // of the lights on the surface; unit: klx
};

LiveLight::LiveLight(const PreparedScene& scene, const LightSet& light,
                     LightTable resting, const AlbedoAt& albedo, int threads)
    : scene_(scene),
      light_(light),
      threads_(threads),
      rays_(scene, RayScene::Detail::coarsest, RayScene::Part::solid),
      directions_(sphere_directions()),
      resting_(std::move(resting)),
      out_(resting_) {
  find_albedos(albedo);
  lay_out_grid();
  solve(nullptr, without_);
  find_resting_nodes();
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
  grid_.lay_out(box);
}

void LiveLight::find_movers() {
  movers_.clear();
  for (const PlacedMesh& piece : scene_.placed)
    if (piece.moves && piece.there) movers_.push_back({piece.centre, piece.radius + kAway});
}

// direction: unit length.
bool LiveLight::meets_mover(const Vec3f& from, const Vec3f& direction, float farthest) const {
  return std::any_of(movers_.begin(), movers_.end(), [&](const Sphere& mover) {
    const Vec3f to = mover.centre - from;
    const float along = std::clamp(dot(to, direction), 0.0f, farthest);
    const Vec3f off = to - direction * along;
    return dot(off, off) <= mover.radius * mover.radius;
  });
}

// resting: the solution without anything that moves. What no mover touches is taken from there, to the same bits.
void LiveLight::solve(const Solution* resting, Solution& out) {
  rays_.follow();
  find_movers();
  if (movers_.size() > kMostMovers) resting = nullptr;
  const std::size_t count = grid_.count(), row = grid_.row();
  out.hits.resize(count * kDirections);
  out.first.resize(count), out.second.resize(count);
  std::vector<std::uint8_t> kept(count, 0);
  parallel_for(count / row, threads_, [&](std::size_t job) {
    for (std::size_t i = job * row; i < (job + 1) * row; ++i) {
      kept[i] = trace(i, resting, out.hits);
      out.first[i] = kept[i] ? resting->first[i] : gather(out.hits, i * kDirections, nullptr);
    }
  });
  out.first_filled = grid_.fill_inside(out.first);
  std::vector<std::uint8_t> changed;
  if (resting) changed = grid_.find_changed_cells(resting->first_filled, out.first_filled);
  const auto sees_change = [&](std::size_t probe) {
    for (std::size_t r = probe * kDirections; r < (probe + 1) * kDirections; ++r)
      if (out.hits[r].kind == Hit::surface && changed[grid_.cell_of(lookup_of(out.hits[r]))]) return true;
    return false;
  };
  parallel_for(count / row, threads_, [&](std::size_t job) {
    for (std::size_t i = job * row; i < (job + 1) * row; ++i)
      out.second[i] = kept[i] && !sees_change(i) ? resting->second[i]
                                                 : gather(out.hits, i * kDirections, &out.first_filled);
  });
  out.filled = grid_.fill_inside(out.second);
}

// Whether all is as in `resting`.
bool LiveLight::trace(std::size_t probe, const Solution* resting, std::vector<Hit>& hits) const {
  const Vec3f from = grid_.point_of(probe);
  bool kept = resting;
  for (std::size_t r = 0; r < directions_.size(); ++r) {
    Hit& hit = hits[probe * kDirections + r];
    const Hit* const before = resting ? &resting->hits[probe * kDirections + r] : nullptr;
    const bool met = !before || meets_mover(from, directions_[r], before->distance);
    hit = met ? trace_ray(from, directions_[r]) : *before;
    if (hit.kind == Hit::surface && (met || !keeps_lights(hit))) hit.direct = light_of(hit);
    kept = kept && !met && hit.direct == before->direct;
  }
  return kept;
}

// Without the lights on what it meets. direction: unit length.
LiveLight::Hit LiveLight::trace_ray(const Vec3f& from, const Vec3f& direction) const {
  const RayScene::Hit met = rays_.cast(from, direction, 0, kLightReach);
  Hit hit;
  hit.kind = met.triangle == RayScene::kNone ? Hit::sky : met.back ? Hit::inside : Hit::surface;
  if (hit.kind != Hit::sky) hit.distance = met.distance;
  if (hit.kind != Hit::surface) return hit;
  const RayScene::Triangle triangle = rays_.triangle(met.triangle);
  const PlacedMesh& piece = scene_.placed[triangle.placed];
  const PreparedMesh& mesh = scene_.meshes[piece.mesh];
  const PreparedTriangle& source = mesh.triangles[triangle.source];
  const Vec3f p0 = mesh.vertices[source.vertices[0]].position;
  const Vec3f area = cross(mesh.vertices[source.vertices[1]].position - p0,
                           mesh.vertices[source.vertices[2]].position - p0);
  hit.normal = normalized(Vec3f(piece.world_from_mesh.rotation.rotate(Vec3(area))));
  hit.point = from + direction * met.distance + hit.normal * 0.01f;
  hit.albedo = albedos_[source.material];
  return hit;
}

// No mover stands between what was met and a light that may shine on it.
bool LiveLight::keeps_lights(const Hit& hit) const {
  for (const LightModel& light : light_.lights) {
    const LightModel::Sample sample = light.at(hit.point);
    if (dot(sample.to_light, hit.normal) <= 0 || luminance(sample.illuminance) <= 0) continue;
    if (meets_mover(hit.point, sample.to_light, std::min(sample.distance * 0.999f, kLightReach))) return false;
  }
  return true;
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
LightProbe LiveLight::gather(const std::vector<Hit>& hits, std::size_t first, const Probes* lit) const {
  LightProbe probe;
  int inside = 0;
  for (std::size_t r = 0; r < directions_.size(); ++r) {
    const Hit& hit = hits[first + r];
    const Vec3f& w = directions_[r];
    Vec3f radiance;
    if (hit.kind == Hit::sky) {
      radiance = light_.sky.radiance(w);
    } else if (hit.kind == Hit::surface) {
      Vec3f e = hit.direct;
      if (lit) e += grid_.sample(*lit, lookup_of(hit)).illuminance(hit.normal);
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

Vec3f LiveLight::lookup_of(const Hit& hit) const { return hit.point + multiply(grid_.cell(), hit.normal) * kOff; }

// Where light is looked up for a node: half a cell off its surface.
Vec3f LiveLight::lookup_of(const PlacedMesh& piece, std::size_t node, Vec3f& normal) const {
  const LightNode& light_node = scene_.meshes[piece.mesh].light_nodes[node];
  const Vec3f at(piece.world_from_mesh * (Vec3(light_node.position) * piece.scale));
  normal = Vec3f(piece.world_from_mesh.rotation.rotate(Vec3(light_node.normal)));
  return at + multiply(grid_.cell(), normal) * kOff;
}

void LiveLight::find_resting_nodes() {
  nodes_.assign(resting_.size(), {});
  parallel_for(scene_.placed.size(), threads_, [&](std::size_t i) {
    const PlacedMesh& piece = scene_.placed[i];
    if (piece.moves) return;
    const PreparedMesh& mesh = scene_.meshes[piece.mesh];
    for (std::size_t v = 0; v < mesh.light_nodes.size(); ++v) {
      if (!grid_.covers(Vec3f(piece.world_from_mesh * (Vec3(mesh.light_nodes[v].position) * piece.scale)))) continue;
      Vec3f n;
      const Vec3f near = lookup_of(piece, v, n);
      RestingNode& node = nodes_[piece.first_light + v];
      node.cell = std::int32_t(grid_.cell_of(near));
      node.before = luminance(grid_.sample(without_.filled, near).illuminance(n));
    }
  });
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
    const LightProbe probe = grid_.sample(now_.filled, at + multiply(grid_.cell(), n) * kOff);
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

// Only where a probe about it has changed: elsewhere nothing is taken away.
void LiveLight::light_resting(const PlacedMesh& piece) {
  const std::size_t count = scene_.meshes[piece.mesh].light_nodes.size();
  for (std::size_t v = 0; v < count; ++v) {
    const RestingNode& node = nodes_[piece.first_light + v];
    if (node.cell < 0 || !changed_[std::size_t(node.cell)]) continue;
    Vec3f n;
    const Vec3f near = lookup_of(piece, v, n);
    const float now = luminance(grid_.sample(now_.filled, near).illuminance(n));
    if (now >= node.before) continue;
    const float kept = now / node.before;
    const BakedLight& baked = resting_[piece.first_light + v];
    BakedLight& out = out_[piece.first_light + v];
    out.x = to_half(from_half(baked.x) * kept);
    out.y = to_half(from_half(baked.y) * kept);
    out.z = to_half(from_half(baked.z) * kept);
  }
}

void LiveLight::set_resting(std::uint32_t piece, const BakedLight* light) {
  const PlacedMesh& placed = scene_.placed[piece];
  const std::size_t count = scene_.meshes[placed.mesh].light_nodes.size();
  std::copy_n(light, count, resting_.begin() + placed.first_light);
  std::copy_n(light, count, out_.begin() + placed.first_light);
  if (!changed_.empty() && placed.there) light_resting(placed);
}

const LightTable& LiveLight::update() {
  solve(&without_, now_);
  changed_ = grid_.find_changed_cells(without_.filled, now_.filled);
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
