#include "render/reference/wave.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/portable_math.h"
#include "kernel/base/quick_math.h"
#include "render/camera/projection.h"
#include "render/geometry/glass_sheets.h"
#include "render/media/air_volume.h"

namespace rubble {

namespace {

constexpr float kFarthest = 1e5f;    // unit: m
constexpr int kMostSheets = 32;      // of glass that a path goes straight through
constexpr int kMostBacks = 16;       // surfaces seen from behind that the camera's ray passes
constexpr float kVeilFrom = 12;      // as in shaders/resolve.frag.glsl; unit: m
constexpr float kSurvival = 1.5f;    // of Russian roulette, see survive()
constexpr float kRoughSpread = 0.1f; // of rays that a rough surface sends on; unit: m/m
constexpr float kSharpen = 0.35f;    // the samples of a pixel average a finer texture themselves

Vec3f times(const Vec3f& a, const Vec3f& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
float largest(const Vec3f& c) { return std::max(c.x, std::max(c.y, c.z)); }

struct Basis {
  explicit Basis(const Vec3f& normal) : z(normal) {
    const Vec3f side = std::fabs(z.z) < 0.9f ? Vec3f(0, 0, 1) : Vec3f(1, 0, 0);
    x = normalized(cross(side, z));
    y = cross(z, x);
  }
  Vec3f to_local(const Vec3f& v) const { return {dot(v, x), dot(v, y), dot(v, z)}; }
  Vec3f to_world(const Vec3f& v) const { return x * v.x + y * v.y + z * v.z; }
  Vec3f x, y, z;
};

// Off the surface by more than the rounding of its position.
Vec3f lifted(const SurfacePoint& s) {
  const float size = std::max(std::fabs(s.position.x),
                              std::max(std::fabs(s.position.y), std::fabs(s.position.z)));
  return s.position + s.face_normal * (1e-4f + 2e-6f * size);
}

// A bumped normal must not turn away from where it is seen from, or a mirror would show what is behind.
Vec3f facing(const Vec3f& normal, const Vec3f& face, const Vec3f& out) {
  constexpr float kLeast = 0.005f;
  const float cosine = dot(normal, out);
  if (cosine > kLeast) return normal;
  const Vec3f bent = normalized(normal + out * (kLeast - cosine));
  return dot(bent, out) > 0 ? bent : face;
}

// The balance heuristic.
float weigh(float density, float other) { return density / (density + other); }

}  // namespace

Wave::Wave(const TracedScene& scene, const TracedView& view, const TraceOptions& options)
    : scene_(scene), view_(view), options_(options), towards_(scene.lights.count() + 1) {}

SamplePair Wave::draw(const Path& path, Use use) const {
  const int segment = path.bounces + path.sheets * (options_.most_bounces + 1);
  return path.numbers.pair(path.sample, std::uint32_t(segment * kUses + use));
}

// False: the lens sees nothing there.
bool Wave::aim(Path& path, int u, int v) {
  const Intrinsics& k = view_.rays.intrinsics;
  const SamplePair at = options_.jitter ? draw(path, kLens) : SamplePair{0.5f, 0.5f};
  const double dx = double(at.x) - 0.5, dy = double(at.y) - 0.5;
  Vec3 d;
  if (view_.rays.directions) {
    d = view_.rays.direction(u, v);
    if (d == Vec3()) return false;
    const int u0 = std::max(u - 1, 0), u1 = std::min(u + 1, k.width - 1);
    const int v0 = std::max(v - 1, 0), v1 = std::min(v + 1, k.height - 1);
    const Vec3 left = view_.rays.direction(u0, v), right = view_.rays.direction(u1, v);
    const Vec3 above = view_.rays.direction(u, v0), below = view_.rays.direction(u, v1);
    const bool all = !(left == Vec3() || right == Vec3() || above == Vec3() || below == Vec3());
    if (all && u1 > u0 && v1 > v0)
      d = normalized(d + (right - left) * (dx / (u1 - u0)) + (below - above) * (dy / (v1 - v0)));
  } else {
    d = normalized(Vec3((u + dx - k.cx) / k.fx, (v + dy - k.cy) / k.fy, 1));
  }
  const Pose world_from_optical = view_.rays.pose(v);
  path.from = Vec3f(world_from_optical.translation);
  path.direction = normalized(Vec3f(world_from_optical.rotation.rotate(d)));
  path.nearest = kNearPlane / std::max(float(d.z), 0.05f);
  path.spread = kSharpen / float(k.fx);
  path.lamp = &view_.lamp(v);
  return true;
}

void Wave::begin(const PixelBox& box, int first, int last) {
  paths_.clear();
  active_.clear();
  first_ = true;
  const int width = view_.rays.intrinsics.width;
  for (int sample = first; sample < last; ++sample) {
    for (int i = 0; i < box.width * box.height; ++i) {
      const int u = box.x + i % box.width, v = box.y + i / box.width;
      Path path;
      path.pixel = std::uint32_t(i), path.sample = std::uint32_t(sample);
      path.numbers = SampleSequence(options_.seed, std::uint32_t(v * width + u));
      if (aim(path, u, v)) active_.push_back(std::uint32_t(paths_.size()));
      paths_.push_back(path);
    }
  }
}

void Wave::cast(RayScene::Order order) {
  rays_.clear();
  for (const std::uint32_t index : active_) {
    const Path& path = paths_[index];
    rays_.push_back({path.from, path.nearest, path.direction, kFarthest});
  }
  hits_.resize(rays_.size());
  scene_.rays.cast_many(rays_.data(), rays_.size(), order, hits_.data());
}

// What faces away from the camera is not drawn.
void Wave::pass_backs(std::size_t active) {
  RayScene::PreciseHit& hit = hits_[active];
  RayScene::Ray ray = rays_[active];
  for (int i = 0; i < kMostBacks && hit.triangle != RayScene::kNone && hit.back; ++i) {
    ray.nearest = just_behind(hit.distance);
    scene_.rays.cast_many(&ray, 1, RayScene::Order::scattered, &hit);
  }
}

Wave::Met Wave::met(std::size_t active) const {
  Met out{hits_[active]};
  if (!scene_.sheets || !scene_.sheets->any()) return out;
  RayScene::Ray ray = rays_[active];
  if (out.hit.triangle != RayScene::kNone) ray.farthest = out.hit.distance;
  const RayScene::PreciseHit sheet = scene_.sheets->next(ray);
  if (sheet.triangle != RayScene::kNone) out = {sheet, true};
  return out;
}

bool Wave::step() {
  if (active_.empty()) return false;
  const bool first = first_;
  first_ = false;
  cast(first ? RayScene::Order::coherent : RayScene::Order::scattered);
  next_.clear();
  for (std::size_t i = 0; i < active_.size(); ++i) {
    if (first) pass_backs(i);
    if (follow(active_[i], met(i))) next_.push_back(active_[i]);
  }
  for (std::size_t i = 0; i + 1 < towards_.size(); ++i)
    answer(towards_[i], RayScene::Order::coherent);
  answer(towards_.back(), RayScene::Order::scattered);
  active_.swap(next_);
  return true;
}

bool Wave::follow(std::uint32_t index, const Met& met) {
  Path& path = paths_[index];
  const RayScene::PreciseHit& hit = met.hit;
  const bool open = hit.triangle == RayScene::kNone;
  if (!scene_.air.clear()) {
    float near = path.air_from, far = open ? kFarthest : hit.distance, at = 0;
    const bool camera = path.bounces == 0;
    if (camera) far = std::min(far, float(AirVolume::kFarthest));
    if (camera || scene_.air.clip(path.from, path.direction, near, far)) {
      light_air_along(index, near, far);
      if (scene_.air.find_event(path.from, path.direction, near, far, draw(path, kAir).x, at))
        return scatter_in_air(index, at);
    }
  }
  if (open) return leave(path);
  if (hit.back) return false;  // inside a piece it is dark
  return reflect(index, met);
}

bool Wave::leave(Path& path) {
  if (path.density <= 0) {
    path.light += times(path.throughput, scene_.lights.backdrop(path.direction));
    return false;
  }
  const float share = weigh(path.density, scene_.lights.sky_sampler().density(path.direction));
  path.light += times(path.throughput, scene_.lights.sky(path.direction)) * share;
  return false;
}

// From the second reflection on, a path goes on with a chance of kSurvival times what it still carries.
// The first always goes on: half the noise for a quarter more time, measured in a void and outside.
bool Wave::survive(Path& path, float random) {
  const float carried = largest(path.throughput);
  if (!(carried > 0) || path.bounces >= options_.most_bounces) return false;
  const float chance = path.bounces <= 1 ? 1.0f : std::min(1.0f, kSurvival * carried);
  if (random >= chance) return false;
  path.throughput *= 1 / chance;
  return true;
}

bool Wave::scatter_in_air(std::uint32_t index, float at) {
  Path& path = paths_[index];
  const Vec3f p = path.from + path.direction * at;
  path.throughput *= scene_.air.albedo();
  light_air(index, p);
  const SamplePair choices = draw(path, kChoices);
  const Vec3f in =
      scene_.air.sample_phase(p, path.direction, draw(path, kReflect), choices.x);
  path.density = scene_.air.phase(p, dot(path.direction, in));
  path.from = p, path.direction = in, path.nearest = path.air_from = 0;
  path.spread = kRoughSpread;
  ++path.bounces;
  return survive(path, choices.y);
}

// Goes straight on; share: of the light that passes, over the chance that it is followed.
bool Wave::pass_sheet(Path& path, const Vec3f& share, float distance) const {
  path.throughput = times(path.throughput, share);
  path.nearest = just_behind(distance), path.air_from = distance;
  return ++path.sheets < kMostSheets;
}

bool Wave::reflect(std::uint32_t index, const Met& met) {
  Path& path = paths_[index];
  const RayScene::PreciseHit& hit = met.hit;
  const SamplePair choices = draw(path, kChoices);
  const RayScene::Triangle triangle = met.sheet ? scene_.sheets->triangle(hit.triangle) : scene_.rays.triangle(hit.triangle);
  SurfacePoint surface;
  scene_.surfaces.find({triangle, hit.u, hit.v, path.direction, path.spread * hit.distance}, surface);
  // Of the second number the path needs whether it goes on, of the first what it does.
  const float chance = (surface.passed.x + surface.passed.y + surface.passed.z) * (1.0f / 3);
  const bool passes = met.sheet && choices.x < chance;
  const Vec3f arriving = path.throughput;
  if (!path.met_surface && path.bounces == 0) {
    if (!passes) {
      path.met_surface = true, path.first_distance = hit.distance;
      path.albedo = mean_albedo(surface.reflection), path.normal = surface.normal;
    }
    // Clean air veils what is far: the horizon has no edge.
    const float there = std::max(hit.distance - kVeilFrom, 0.0f);
    const float veil = quick::exp2(scene_.surrounded ? -there * 5.64e-4f
                                                   : -there * there * 4e-5f / (1 + there * 0.012f));
    if (veil < 1) {
      const Vec3f level = normalized(Vec3f(path.direction.x, path.direction.y, 0.02f));
      const Vec3f before = times(path.throughput, Vec3f(1, 1, 1) - surface.passed);  // what passes is veiled there
      path.light += times(before, scene_.lights.sky(level)) * (1 - veil);
      path.throughput *= veil;
    }
  }
  path.light += times(path.throughput, surface.emission);
  if (path.bounces == 0) path.light += times(path.throughput, surface.glow);
  const Vec3f out = -path.direction;
  if (!surface.reflection.matt()) surface.normal = facing(surface.normal, surface.face_normal, out);
  light_surface(index, surface, out);
  if (passes) {
    path.throughput = arriving;
    return pass_sheet(path, surface.passed * (1 / chance), hit.distance);
  }
  if (met.sheet) path.throughput *= 1 / (1 - chance);
  const Basis basis(surface.normal);
  const ReflectedSample sample =
      sample_reflection(surface.reflection, basis.to_local(out), draw(path, kReflect),
                        met.sheet ? (choices.x - chance) / (1 - chance) : choices.x);
  const Vec3f in = basis.to_world(sample.in);
  if (sample.density <= 0 || dot(in, surface.face_normal) <= 0) return false;
  path.throughput = times(path.throughput, sample.weight);
  path.from = lifted(surface), path.direction = in, path.nearest = path.air_from = 0;
  path.density = sample.density, path.spread = kRoughSpread;
  ++path.bounces;
  return survive(path, choices.y);
}

void Wave::ask(std::uint32_t index, std::size_t list, const Vec3f& from, const Vec3f& to_light,
               float distance, const Vec3f& light) {
  if (!(largest(light) > 0)) return;
  const std::size_t where = paths_[index].bounces == 0 ? list : towards_.size() - 1;
  towards_[where].rays.push_back({from, 0, to_light, distance * 0.9999f});
  towards_[where].shadows.push_back({index, light});
}

void Wave::answer(ShadowList& list, RayScene::Order order) {
  if (list.rays.empty()) return;
  hidden_.resize(list.rays.size());
  scene_.rays.blocked_many(list.rays.data(), list.rays.size(), order, hidden_.data());
  const bool sheets = scene_.sheets && scene_.sheets->any();
  for (std::size_t i = 0; i < list.rays.size(); ++i) {
    if (hidden_[i]) continue;
    const Vec3f& light = list.shadows[i].light;
    paths_[list.shadows[i].path].light += sheets ? times(light, passed(list.rays[i])) : light;
  }
  list.rays.clear();
  list.shadows.clear();
}

Vec3f Wave::passed(RayScene::Ray ray) const {
  Vec3f share(1, 1, 1);
  for (int i = 0; i < kMostSheets; ++i) {
    const RayScene::PreciseHit hit = scene_.sheets->next(ray);
    if (hit.triangle == RayScene::kNone) return share;
    SurfacePoint surface;
    scene_.surfaces.find({scene_.sheets->triangle(hit.triangle), hit.u, hit.v, ray.direction,
                          kRoughSpread * hit.distance},
                         surface);
    share = times(share, surface.passed);
    ray.nearest = just_behind(hit.distance);
  }
  return {};
}

void Wave::light_surface(std::uint32_t index, const SurfacePoint& surface, const Vec3f& out) {
  const Path& path = paths_[index];
  const Basis basis(surface.normal);
  const Vec3f local_out = basis.to_local(out), from = lifted(surface);
  const SamplePair u = draw(path, kLight);
  for (std::size_t i = 0; i < scene_.lights.count(); ++i) {
    const SceneLights::Arrival a = scene_.lights.arrive(i, *path.lamp, surface.position, u);
    if (dot(a.to_light, surface.face_normal) <= 0 || !(largest(a.illuminance) > 0)) continue;
    const Vec3f share = reflect_share(surface.reflection, local_out, basis.to_local(a.to_light));
    if (!(largest(share) > 0)) continue;
    const bool near = scene_.lights.located(i);
    const float passed = near ? scene_.air.passes(from, a.to_light, 0, a.distance)
                              : scene_.air.passes_in_box(from, a.to_light, kFarthest);
    ask(index, i, from, a.to_light, a.distance,
        times(times(path.throughput, share), a.illuminance) * passed);
  }
  const SkySampler::Sample sky = scene_.lights.sky_sampler().draw(draw(path, kSky));
  if (sky.density <= 0 || dot(sky.direction, surface.face_normal) <= 0) return;
  const Vec3f in = basis.to_local(sky.direction);
  const Vec3f share = reflect_share(surface.reflection, local_out, in);
  const float density = reflection_density(surface.reflection, local_out, in);
  const float passed = scene_.air.passes_in_box(from, sky.direction, kFarthest);
  ask(index, towards_.size() - 1, from, sky.direction, kFarthest,
      times(times(path.throughput, share), scene_.lights.sky(sky.direction)) *
          (passed * weigh(sky.density, density) / sky.density));
}

// Of beams and sky; the lights that have a place are seen to by light_air_along().
void Wave::light_air(std::uint32_t index, const Vec3f& p) {
  const Path& path = paths_[index];
  for (std::size_t i = 0; i < scene_.lights.count(); ++i) {
    if (scene_.lights.located(i)) continue;
    const SceneLights::Arrival a = scene_.lights.arrive(i, *path.lamp, p, draw(path, kLight));
    const float phase = scene_.air.phase(p, dot(a.to_light, path.direction));
    const float passed = scene_.air.passes_in_box(p, a.to_light, kFarthest);
    ask(index, i, p, a.to_light, a.distance,
        times(path.throughput, a.illuminance) * (phase * passed));
  }
  const SkySampler::Sample sky = scene_.lights.sky_sampler().draw(draw(path, kSky));
  if (sky.density <= 0) return;
  const float phase = scene_.air.phase(p, dot(sky.direction, path.direction));
  const float passed = scene_.air.passes_in_box(p, sky.direction, kFarthest);
  ask(index, towards_.size() - 1, p, sky.direction, kFarthest,
      times(path.throughput, scene_.lights.sky(sky.direction)) *
          (phase * passed * weigh(sky.density, phase) / sky.density));
}

// One point of the ray for each light that has a place: by equal angles as the light sees the ray,
// which takes out the square of the distance.
void Wave::light_air_along(std::uint32_t index, float near, float far) {
  const Path& path = paths_[index];
  const SamplePair u = draw(path, kAlong), places = draw(path, kLight);
  for (std::size_t i = 0; i < scene_.lights.count(); ++i) {
    if (!scene_.lights.located(i)) continue;
    const Vec3f light = scene_.lights.place(i, *path.lamp, places);
    const float along = dot(light - path.from, path.direction);
    const float aside = std::max(distance(light, path.from + path.direction * along), 1e-3f);
    const float first = quick::atan2(near - along, aside), last = quick::atan2(far - along, aside);
    if (last - first < 1e-6f) continue;
    const float off = aside * quick::tan(first + (last - first) * u.x);
    const float at = std::clamp(along + off, near, far);
    const Vec3f p = path.from + path.direction * at;
    const Vec3f illuminance = scene_.lights.illuminance_from(i, *path.lamp, light, p);
    if (!(largest(illuminance) > 0)) continue;
    const float away = std::max(distance(p, light), 1e-3f);
    const Vec3f to_light = (light - p) * (1 / away);
    const float density = aside / ((last - first) * (aside * aside + off * off));
    const float passed = scene_.air.passes(path.from, path.direction, near, at) *
                         scene_.air.passes(p, to_light, 0, away);
    const float scattered = scene_.air.scattering(p, dot(to_light, path.direction));
    ask(index, i, p, to_light, away,
        times(path.throughput, illuminance) * (passed * scattered / density));
  }
}

}  // namespace rubble
