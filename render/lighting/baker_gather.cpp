// What a point of a bake finds by its rays.
#include <algorithm>
#include <cmath>
#include <map>

#include "kernel/base/portable_math.h"
#include "render/lighting/baker.h"
#include "render/lighting/light_packing.h"
#include "render/materials/tile_noise.h"

namespace rubble {

namespace {

constexpr float kNoise = 0.02f;        // standard error that may be left at a point whose room is ...
constexpr float kWide = 0.3f;          // ... this (unit: m); more in cracks, of which little is seen, ...
constexpr float kCrack = 0.25f;        // ... by the room over kWide, or by this if that is more
constexpr float kFaint = 0.0005f;      // of the sky's mean light: noise fainter than that of so much does not count
constexpr float kHidden = 0.03f;       // room of what no camera comes near enough to see; unit: m
constexpr float kAbout = 1;            // cell of space whose rays tell how much light varies; unit: m
constexpr float kLift = 0.002f;        // rays start this far off the surface; unit: m
constexpr float kSoil = 0.4f;          // above soil that lies on the plane; unit: m
constexpr double kBeside = 0.5;        // of the pile's box: so far out the plane is found as it is; unit: m
constexpr float kMostInside = 0.3f;    // share of rays that may meet a piece from inside
constexpr float kRaysAround = 80;      // at most of a point of the surroundings, which the eye does not come near to
constexpr std::size_t kDirectPlaces = 32;  // of a point, from which it looks for the lights
constexpr float kOneFace = 0.999f;     // least cosine between normals on one face
constexpr float kSunSine = 0.00465f;   // radius of the sun's disc; unit: rad

void basis_about(const Vec3f& n, float turn, Vec3f& x, Vec3f& y) {
  const Vec3f side = std::fabs(n.z) < 0.9f ? Vec3f(0, 0, 1) : Vec3f(1, 0, 0);
  const Vec3f a = normalized(cross(side, n)), b = cross(n, a);
  const portable::SinCos t = portable::sincos(2 * portable::kPi * double(turn));
  x = a * float(t.cos) + b * float(t.sin);
  y = b * float(t.cos) - a * float(t.sin);
}

}  // namespace

void Baker::Sum::add(const Vec3f& radiance, const Vec3f& w, float cosine) {
  const float bright = luminance(radiance);
  light += radiance, squares += bright * bright;
  direction += w * (bright / std::max(cosine, 0.35f));
  ++rays;
}

Vec3f Baker::Fan::direction(std::size_t k) const {
  const Spoke& spoke = spokes[k];
  const float u = (spoke.stratum + height) / float(spokes.size()), r = std::sqrt(u);
  return x * (r * spoke.cos) + y * (r * spoke.sin) + z * std::sqrt(1 - u);
}

Baker::Fan Baker::fan(std::size_t point, std::uint32_t round) const {
  const std::uint32_t seed = std::uint32_t(options_.seed);
  Fan fan{round == 0 ? first_spokes_ : spokes_, {}, {}, places_[point].normal, 0};
  basis_about(fan.z, lattice_value(int(point), int(round), seed), fan.x, fan.y);
  fan.height = std::min(lattice_value(int(point), int(round), seed + 0x68bc21ebu), 0.999f);
  return fan;
}

std::size_t Baker::origin_count(const Point& p) const {
  return scene_.meshes[scene_.placed[p.piece].mesh].bake_points[p.source].origin_count;
}

BakeOrigin Baker::origin(const Point& p, std::size_t i) const {
  const PlacedMesh& placed = scene_.placed[p.piece];
  const PreparedMesh& mesh = scene_.meshes[placed.mesh];
  const BakeOrigin& source = mesh.bake_origins[mesh.bake_points[p.source].first_origin + i];
  const Vec3f normal(placed.world_from_mesh.rotation.rotate(Vec3(source.normal)));
  const Vec3f place(placed.world_from_mesh * (Vec3(source.position) * placed.scale));
  return {place + normal * (below_soil(p) ? kSoil : kLift), normal};
}

// The plane goes on below the soil of the surroundings. Were it dark there, it would be dark up to the soil's rim, for
// light is taken from between points.
bool Baker::below_soil(const Point& p) const {
  if (!scene_.surrounded || scene_.placed[p.piece].id != kGroundId || scene_.bounds.empty()) return false;
  const Vec3 low = scene_.bounds.min, high = scene_.bounds.max;
  const double x = double(place_of(p).position.x), y = double(place_of(p).position.y);
  return x < low.x - kBeside || x > high.x + kBeside || y < low.y - kBeside || y > high.y + kBeside;
}

// The point nearest to one of the nodes about a place, drawn by its weight there, so that the mean over many rays
// is that of the light between nodes. draw: in [0, 1).
std::uint32_t Baker::drawn_point(const RayScene::PreciseHit& hit, float draw) const {
  const RayScene::Triangle t = rays_->triangle(hit.triangle);
  const std::uint32_t mesh = scene_.placed[t.placed].mesh;
  const LightNodes nodes = find_light_nodes(scene_.meshes[mesh], t.source, hit.u, hit.v);
  const std::size_t k = draw < nodes.weight[0] ? 0 : draw < nodes.weight[0] + nodes.weight[1] ? 1 : 2;
  return first_point_[t.placed] + nearest_points_[mesh][nodes.node[k]];
}

float Baker::cleared(const RayScene::Ray& ray, float farthest) const {
  if (!sheets_.any()) return 1;
  const Vec3f passed = sheets_.passed({ray.from, ray.nearest, ray.direction, farthest});
  return (passed.x + passed.y + passed.z) * (1.0f / 3);
}

float Baker::first_cleared(std::size_t ray) const {
  return first_cleared_.empty() ? 1 : float(first_cleared_[ray]) * (1.0f / 255);
}

// Which of its origins are inside a piece shows in what their rays meet.
void Baker::trace(std::size_t i) {
  Point& p = points_[i];
  const std::size_t count = first_spokes_.size(), origins = origin_count(p);
  std::array<Vec3f, kMostOrigins> from;
  for (std::size_t o = 0; o < origins; ++o) from[o] = origin(p, o).position;
  const Fan fan = this->fan(i, 0);
  std::array<RayScene::Ray, kFirstRays> rays;
  std::array<RayScene::PreciseHit, kFirstRays> hits;
  for (std::size_t r = 0; r < count; ++r)
    rays[r] = {from[r % origins], 0, fan.direction(r), kLightReach};
  rays_->cast_many(rays.data(), count, RayScene::Order::scattered, hits.data());
  std::array<int, kMostOrigins> cast{}, inside{};
  for (std::size_t r = 0; r < count; ++r)
    ++cast[r % origins], inside[r % origins] += hits[r].triangle != RayScene::kNone && hits[r].back;
  for (std::size_t o = 0; o < origins; ++o)
    if (float(inside[o]) <= kMostInside * float(cast[o])) p.open = std::uint8_t(p.open | 1u << o);
  const std::uint32_t draws = std::uint32_t(options_.seed) + 0x51ed270bu;
  float near = 0, seen = 0, room = 0;
  for (std::size_t r = 0; r < count; ++r) {
    std::uint32_t& code = first_hits_[i * count + r];
    code = kNone;
    if (!(p.open >> (r % origins) & 1u)) continue;
    const bool open = hits[r].triangle == RayScene::kNone;
    seen += 1, near += open ? 0 : 1 / std::max(hits[r].distance, 0.01f);
    room += open ? kWide : std::min(hits[r].distance, kWide);
    code = open ? kSky : hits[r].back ? kInside : drawn_point(hits[r], lattice_value(int(i), int(r), draws));
    if (!first_cleared_.empty())
      first_cleared_[i * count + r] =
          std::uint8_t(255 * cleared(rays[r], open ? kLightReach : hits[r].distance) + 0.5f);
    if (open) sky_[i] += light_.sky.radiance(rays[r].direction) * first_cleared(i * count + r);
  }
  sky_[i] = seen > 0 ? sky_[i] * (1 / seen) : Vec3f();
  p.clearance = near > 0 ? seen / near : kLightReach;
  p.room = room / std::max(seen, 1.0f);
  find_direct(i);
  if (light_.far.empty()) return;
  const Vec3f near_light = p.direct;
  far_vectors_[i] = find_far(p);
  far_light_[i] = p.direct - near_light;
}

// From places on the surface that the point stands for: its origins, then places from each on the way to another that lies
// on the same face; as many for one as for another. Sunbeams in a void are narrow, and all light there may be theirs.
std::vector<BakeOrigin> Baker::direct_places(std::size_t i) const {
  const Point& p = points_[i];
  std::vector<BakeOrigin> out;
  out.reserve(kDirectPlaces);
  for (std::size_t o = 0; o < origin_count(p); ++o)
    if (p.open >> o & 1u) out.push_back(origin(p, o));
  const std::size_t origins = out.size();
  if (origins < 2) return out;
  for (std::size_t k = 0; out.size() < kDirectPlaces; ++k) {
    const BakeOrigin a = out[k % origins], b = out[(k + 1 + k / origins % (origins - 1)) % origins];
    const bool one_face =
        dot(a.normal, b.normal) >= kOneFace && std::fabs(dot(a.normal, b.position - a.position)) <= kLift;
    const float part = lattice_value(int(i), int(k), std::uint32_t(options_.seed) + 0x2545f491u);
    out.push_back({one_face ? a.position + (b.position - a.position) * part : a.position, a.normal});
  }
  return out;
}

// The mean over these places, each from another spot of the sun's disc.
void Baker::find_direct(std::size_t i) {
  Point& p = points_[i];
  p.direct = Vec3f();
  const std::vector<BakeOrigin> places = direct_places(i);
  for (const LightModel& l : light_.lights) {
    std::array<RayScene::Ray, kDirectPlaces> rays;
    std::array<Vec3f, kDirectPlaces> light;
    std::size_t count = 0;
    for (std::size_t o = 0; o < places.size(); ++o) {
      const BakeOrigin& from = places[o];
      const LightModel::Sample sample = l.at(from.position);
      Vec3f to_light = sample.to_light, x, y;
      if (l.type == LightType::directional) {
        basis_about(to_light, float(o) * 0.618034f, x, y);
        to_light = normalized(to_light + x * (kSunSine * std::sqrt((float(o) + 0.5f) / float(kDirectPlaces))));
      }
      const float facing = dot(to_light, from.normal);
      if (facing <= 0 || luminance(sample.illuminance) <= 0) continue;
      rays[count] = {from.position, 0, to_light, std::min(sample.distance * 0.999f, kLightReach)};
      light[count++] = sample.illuminance * (facing / float(places.size()));
    }
    std::array<std::uint8_t, kDirectPlaces> hidden;
    if (count) rays_->blocked_many(rays.data(), count, RayScene::Order::coherent, hidden.data());
    for (std::size_t k = 0; k < count; ++k)
      if (!hidden[k]) p.direct += light[k] * cleared(rays[k], rays[k].farthest);
  }
}

// From the first of its origins that is outside all pieces: what is far varies little from one to the next.
Vec3f Baker::find_far(Point& p) const {
  Vec3f vector;
  std::size_t o = 0;
  while (o < origin_count(p) && !(p.open >> o & 1u)) ++o;
  if (o == origin_count(p)) return vector;
  const BakeOrigin from = origin(p, o);
  for (const LightModel& l : light_.far) {
    const LightModel::Sample sample = l.at(from.position);
    const float facing = dot(sample.to_light, from.normal);
    if (facing <= 0 || luminance(sample.illuminance) <= 0) continue;
    const float distance = std::min(sample.distance * 0.999f, kLightReach);
    if (rays_->blocked(from.position, sample.to_light, 0, distance)) continue;
    const float clear = cleared({from.position, 0, sample.to_light, distance}, distance);
    p.direct += sample.illuminance * (facing * clear);
    vector += sample.to_light * (luminance(sample.illuminance) * clear);
  }
  return vector;
}

void Baker::gather_first(std::size_t i) {
  const std::size_t count = first_spokes_.size();
  const std::uint32_t* codes = first_hits_.data() + i * count;
  Vec3f sum;
  int rays = 0;
  for (std::size_t r = 0; r < count; ++r) {
    rays += codes[r] != kNone;
    if (codes[r] < kNone) sum += radiance_at(codes[r]) * first_cleared(i * count + r);
  }
  points_[i].indirect = rays ? (sum * (1 / float(rays)) + sky_[i]) * portable::kPiF : Vec3f();
}

Baker::Sum Baker::first_sum(std::size_t i) const {
  Sum sum;
  const std::size_t count = first_spokes_.size();
  const Fan fan = this->fan(i, 0);
  for (std::size_t r = 0; r < count; ++r) {
    const std::uint32_t code = first_hits_[i * count + r];
    if (code == kNone) continue;
    const Vec3f w = fan.direction(r);
    const Vec3f light = code == kSky ? light_.sky.radiance(w) : code == kInside ? Vec3f() : radiance_at(code);
    sum.add(light * first_cleared(i * count + r), w, dot(w, fan.z));
  }
  return sum;
}

void Baker::add_round(std::size_t i, std::uint32_t round, Sum& sum) const {
  const Point& p = points_[i];
  std::array<Vec3f, kMostOrigins> from;
  std::size_t origins = 0;
  for (std::size_t o = 0; o < origin_count(p); ++o)
    if (p.open >> o & 1u) from[origins++] = origin(p, o).position;
  const Fan fan = this->fan(i, round);
  std::array<RayScene::Ray, kRound> rays;
  std::array<RayScene::PreciseHit, kRound> hits;
  const std::size_t count = spokes_.size();
  for (std::size_t r = 0; r < count; ++r)
    rays[r] = {from[(r + round) % origins], 0, fan.direction(r), kLightReach};
  rays_->cast_many(rays.data(), count, RayScene::Order::scattered, hits.data());
  const std::uint32_t draws = std::uint32_t(options_.seed) + round * 0x9e3779b9u;
  for (std::size_t r = 0; r < count; ++r) {
    const Vec3f& w = rays[r].direction;
    const bool open = hits[r].triangle == RayScene::kNone;
    const Vec3f light = open ? light_.sky.radiance(w)
                        : hits[r].back ? Vec3f()
                                       : radiance_[drawn_point(hits[r], lattice_value(int(i), int(r), draws))];
    sum.add(light * cleared(rays[r], open ? kLightReach : hits[r].distance), w, dot(w, fan.z));
  }
}

// about: what rays near the point say, its own among them.
int Baker::rounds_for(const Point& p, float noise_left, const Sum& about) const {
  if (!p.open || p.room < kHidden || about.rays == 0) return 0;
  const float freedom = std::clamp(p.room / kWide, kCrack, 1.0f);
  const float mean = luminance(about.light) / float(about.rays);
  const float variance = std::max(about.squares / float(about.rays) - mean * mean, 0.0f);
  // Of direct light half is counted, for a place beside the point may lie in shadow.
  const float light = mean + 0.5f * luminance(p.direct) / portable::kPiF + kFaint * luminance(light_.sky.mean);
  const float error = kNoise / freedom * light;
  if (error <= 0) return 0;
  // Directions that are spread evenly have about half the noise of chance.
  const float most = scene_.placed[p.piece].surrounds ? std::min(kRaysAround, float(options_.rays)) : float(options_.rays);
  const float needed = std::min(0.25f * variance * noise_left / (error * error), most * freedom);
  return int(std::ceil(std::max(needed - float(first_spokes_.size()), 0.0f) / float(spokes_.size())));
}

// What the first rays of points of one piece and side in a cell of space say together. A point that went by its own
// rays alone would stop too early just where they missed what is bright, and be too dark.
Baker::Regions Baker::look_about(Piece& piece) const {
  Regions regions;
  const auto at = [](float x) { return int(std::floor(x / kAbout)); };
  for (std::uint32_t i = piece.first; i < piece.end; ++i) {
    const Vec3f& p = places_[i].position;
    Region& region = regions[{at(p.x), at(p.y), at(p.z), dominant_direction(places_[i].normal)}];
    region.points.push_back(i);
    const Sum& sum = piece.of(i).sum = first_sum(i);
    region.sum.light += sum.light, region.sum.squares += sum.squares, region.sum.rays += sum.rays;
    region.bright_nearness += bright_nearness(i);
  }
  for (const auto& [cell, region] : regions) {
    const float near = region.bright_nearness;
    const float far = near > 0 ? luminance(region.sum.light) / near : kLightReach;
    for (const std::uint32_t i : region.points) piece.of(i).light_distance = far;
  }
  return regions;
}

// The sum over its first rays of radiance by the inverse distance that it comes from.
float Baker::bright_nearness(std::size_t i) const {
  float sum = 0;
  const std::uint32_t* codes = first_hits_.data() + i * first_spokes_.size();
  for (std::size_t r = 0; r < first_spokes_.size(); ++r)
    if (codes[r] < kNone)
      sum += luminance(radiance_at(codes[r])) /
             std::max(distance(places_[codes[r] & ~BakeLinks::kClosed].position, places_[i].position), 0.01f);
  return sum;
}

void Baker::plan(Piece& piece) const {
  const Regions regions = look_about(piece);
  find_neighbours(piece);
  for (const auto& [cell, region] : regions)
    for (const std::uint32_t i : region.points)
      piece.of(i).rounds = rounds_for(points_[i], piece.of(i).noise_left, region.sum);
}

// Illuminance E = pi / N sum L, and the vector V with E(n') = dot(n', V) for normals near n: V = pi / N
// sum L w / (n.w), its length kept in check where w grazes the surface.
void Baker::gather(std::size_t i, Found& found) const {
  Sum& sum = found.sum;
  for (int round = 1; round <= found.rounds; ++round) add_round(i, std::uint32_t(round), sum);
  const Vec3f& n = places_[i].normal;
  const float scale = portable::kPiF / float(std::max(sum.rays, 1));
  found.arrived.indirect = sum.light * scale;
  found.arrived.vector =
      sum.direction * scale + n * (luminance(found.arrived.indirect) - dot(sum.direction, n) * scale);
}

}  // namespace rubble
