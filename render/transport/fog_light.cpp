#include "render/transport/fog_light.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/quick_math.h"
#include "render/lighting/light_packing.h"
#include "render/media/air_box.h"
#include "render/media/corner_sight.h"

namespace rubble {

namespace {

constexpr double kLampTolerance = 0.02;
constexpr int kLampIterations = 12;
constexpr float kMostFactor = 4;  // of what fog does to baked light
constexpr int kPlaces = 32;       // of a cell, at which the lights are looked for
constexpr float kFromAround = 0.1f;  // share of light from all around in what a surface is asked for
constexpr float kPart = 0.15f;    // of a cell, whose middle tells which corners are seen there; unit: m
constexpr float kLift = 0.01f;    // rays start this far off a surface; unit: m

void add_beam(const Vec3f& illuminance, const Vec3f& to_light, RadianceTerms& out) {
  const Harmonics y = harmonics_of(to_light);
  for (std::size_t t = 0; t < kHarmonics; ++t) out[t] += illuminance * y[t];
}

// Share of a light's beam that passes to p.
float passes_to(const Air& air, const Aabb& box, const LightModel& light, const LightModel::Sample& sample, const Vec3f& p) {
  float near = 0, far = sample.distance;
  if (light.type == LightType::directional && !clip_to_box(box, p, sample.to_light, near, far)) return 1;
  return float(quick::exp(-air.turned_depth(Vec3(p + sample.to_light * near), Vec3(sample.to_light), double(far - near))));
}

}  // namespace

FogLight::FogLight(const PreparedScene& scene, const RayScene& rays, const Aabb& box, const LightSet& light,
                   Radiance radiance, ThreadPool& pool)
    : box_(box),
      light_(light),
      radiance_(std::move(radiance)),
      pool_(pool),
      transfer_(make_air_links(scene, rays, box, pool.threads())) {
  const AirGrid& grid = transfer_.links().grid;
  for (const Vec3f& d : transfer_.links().directions) sky_.push_back(d.z > 0 ? light_.sky.radiance(d) : Vec3f());
  find_lit(rays);
  find_reached(rays);
  AirTransfer::Sources sources;
  sources.sky = sky_.data(), sources.surfaces = radiance_.data();
  find_direct(nullptr, sources);
  find_places(scene, rays);
  AirMatter none;
  none.extinction.resize(grid.count()), none.scattered.resize(grid.count());
  clear_ = transfer_.solve(none, sources, pool_).ends;
  for (std::size_t i = 0; i < clear_.size(); ++i)
    usual_.push_back((clear_[i][0] + sources.direct[i][0]) * harmonics_of({0, 0, 1})[0]);
  field_.grid = grid;
  find_open();
}

// Of the places of its cell that a point sees: sunbeams in a void are narrower than a cell, and may be all light there.
void FogLight::find_lit(const RayScene& rays) {
  const AirGrid& grid = transfer_.links().grid;
  std::vector<Vec3f> places(1);  // from the point
  for (int n = 1; n < kPlaces; ++n) {  // R3 sequence (Roberts 2018)
    const auto part = [n](double step) { return float(n * step - std::floor(n * step)) - 0.5f; };
    places.push_back({part(0.8191725) * grid.cell.x, part(0.6710436) * grid.cell.y, part(0.5497005) * grid.cell.z});
  }
  lit_.assign(light_.lights.size(), std::vector<float>(grid.count()));
  pool_.run(int(grid.count()), 16, [&](int begin, int end) {
    for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i) {
      const Vec3f point = grid.point(i);
      int seen = 0;
      for (const Vec3f& off : places) {
        const Vec3f p = point + off;
        if (dot(off, off) > 0 && rays.blocked(point, off, 0, 1)) continue;
        ++seen;
        for (std::size_t l = 0; l < lit_.size(); ++l) {
          const LightModel::Sample sample = light_.lights[l].at(p);
          lit_[l][i] += float(!rays.blocked(p, sample.to_light, 0, std::min(sample.distance * 0.999f, kLightReach)));
        }
      }
      for (std::vector<float>& lit : lit_) lit[i] /= float(seen);
    }
  });
}

// At some distances within each stretch of a link.
void FogLight::find_reached(const RayScene& rays) {
  constexpr float kApart = 0.3f;  // unit: m
  constexpr int kMost = 8;
  const AirLinks& links = transfer_.links();
  reached_.assign(light_.lights.size(), std::vector<float>(links.seen.size()));
  pool_.run(int(links.grid.count()), 8, [&](int begin, int end) {
    for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i) {
      if (links.nearest[i] != i) continue;
      const Vec3f from = links.grid.point(i);
      for (std::size_t k = 0; k < AirLinks::kDirections; ++k) {
        std::size_t place = links.first_place[i * AirLinks::kDirections + k];
        links.cut(links.length(k, i), [&](float middle, float step) {
          const int count = std::clamp(int(step / kApart) + 1, 2, kMost);
          for (std::size_t l = 0; l < reached_.size(); ++l)
            for (int n = 0; n < count; ++n) {
              const Vec3f p = from + links.directions[k] * (middle + step * ((float(n) + 0.5f) / float(count) - 0.5f));
              const LightModel::Sample sample = light_.lights[l].at(p);
              const bool blocked = rays.blocked(p, sample.to_light, 0, std::min(sample.distance * 0.999f, kLightReach));
              reached_[l][place] += blocked ? 0.0f : 1 / float(count);
            }
          ++place;
        });
      }
    }
  });
}

// Half a cell off the surface, or in the middle of what is left of a narrow gap.
void FogLight::find_places(const PreparedScene& scene, const RayScene& rays) {
  const CornerSight sight(scene, rays, transfer_.links().grid);
  field_.seen = sight.table(kPart, pool_);
  std::vector<std::size_t> first;
  std::size_t count = 0;
  for (const PlacedMesh& placed : scene.placed)
    first.push_back(count), count += scene.meshes[placed.mesh].bake_points.size();
  places_.resize(count);
  pool_.run(int(scene.placed.size()), 1, [&](int begin, int end) {
    for (std::size_t k = std::size_t(begin); k < std::size_t(end); ++k) {
      const PlacedMesh& placed = scene.placed[k];
      const std::vector<BakePoint>& points = scene.meshes[placed.mesh].bake_points;
      for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3f n(placed.world_from_mesh.rotation.rotate(Vec3(points[i].normal)));
        const Vec3f p = Vec3f(placed.world_from_mesh * (Vec3(points[i].position) * placed.scale)) + n * kLift;
        const float free = rays.cast(p, n, 0, 2 * usual_off()).distance;
        const float off = free > 0 ? std::min(0.5f * free, usual_off()) : usual_off();
        places_[first[k] + i] = {kLift + off, sight.seen_from(p + n * off)};
      }
    }
  });
}

float FogLight::usual_off() const { return 0.5f * transfer_.links().cell(); }

// air: none: clear.
void FogLight::find_direct(const Air* air, AirTransfer::Sources& out) const {
  const AirGrid& grid = transfer_.links().grid;
  out.direct.assign(grid.count(), {});
  out.beams.assign(light_.lights.size(), std::vector<RadianceTerms>(grid.count())), out.reached = &reached_;
  for (std::size_t l = 0; l < light_.lights.size(); ++l) {
    const LightModel& model = light_.lights[l];
    pool_.run(int(grid.count()), 256, [&](int begin, int end) {
      for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i) {
        const Vec3f p = grid.point(i);
        const LightModel::Sample sample = model.at(p);
        const float passes = air ? passes_to(*air, box_, model, sample, p) : 1.0f;
        add_beam(sample.illuminance * passes, sample.to_light, out.beams[l][i]);
        for (std::size_t t = 0; t < kHarmonics; ++t) out.direct[i][t] += out.beams[l][i][t] * lit_[l][i];
      }
    });
  }
}

// The sky, and the ground as points at the border see it beyond the box.
void FogLight::find_open() {
  const AirLinks& links = transfer_.links();
  const std::size_t count = links.grid.count();
  Vec3f ground;
  float seen = 0;
  for (std::size_t k = 0; k < AirLinks::kDirections; ++k) {
    if (links.directions[k].z >= 0) continue;
    for (std::size_t i = 0; i < count; ++i) {
      const AirLinks::End& end = links.ends[k * count + i];
      if (links.nearest[i] != i || end.point >= AirLinks::kDark) continue;
      const Vec3f p = links.grid.point(i) + links.directions[k] * end.distance, q = links.grid.nearest(p);
      if (p.x == q.x && p.y == q.y) continue;
      const AirTransfer::Colour& c = radiance_[end.point];
      ground += Vec3f(c.c[0], c.c[1], c.c[2]), seen += 1;
    }
  }
  if (seen > 0) ground *= 1 / seen;
  field_.open = {};
  for (std::size_t k = 0; k < AirLinks::kDirections; ++k) {
    const Vec3f light = links.directions[k].z > 0 ? sky_[k] : ground;
    add_beam(light * (4 * portable::kPiF / AirLinks::kDirections), links.directions[k], field_.open);
  }
}

void FogLight::set_air(const Air& air) {
  air_ = air;
  matter_ = turning_matter(air, transfer_.links().grid), ++matter_version_;
  AirTransfer::Sources sources;
  sources.sky = sky_.data(), sources.surfaces = radiance_.data(), sources.usual = usual_;
  find_direct(&air_, sources);
  day_ = transfer_.solve(matter_, sources, pool_);
  add_up();
}

void FogLight::add_up() {
  field_.terms = day_.ends;
  for (std::size_t i = 0; i < day_.air.size(); ++i)
    for (std::size_t t = 0; t < kHarmonics; ++t) field_.terms[i][t] += day_.air[i][t];
  field_.ends_of_lamp = lamp_.ends, field_.of_lamp = lamp_.air;
  field_.stand_in = day_.stand_in, field_.lamp_stand_in = lamp_.stand_in;
}

FogLight::Change FogLight::change_at(const Vec3f& surface, const Vec3f& normal, const Place& place) const {
  const AirGrid& grid = field_.grid;
  const Vec3f p = surface + normal * place.off;
  if (!(norm(p - grid.nearest(p)) <= usual_off())) return {};  // outside the box
  AirGrid::Corners corners = grid.about(p);
  corners.keep(place.seen, day_.stand_in);
  // With a part of the light from all around, as there may be next to none from before the surface.
  const auto light = [&](const std::vector<RadianceTerms>& field) {
    const RadianceTerms terms = blend_in_stops(field, corners);
    return illuminance_of(terms, normal) + terms[0] * (kFromAround * portable::kPiF * harmonics_of({0, 0, 1})[0]);
  };
  const Vec3f before = light(clear_), ends = light(day_.ends);
  Change out;
  for (int c = 0; c < 3; ++c) out.factor[c] = before[c] > 0 ? std::min(ends[c] / before[c], kMostFactor) : 1.0f;
  out.air = illuminance_between(day_.air, corners, normal, true);
  return out;
}

FogLight::Place FogLight::place_of_mover(const Vec3f& surface, const Vec3f& normal) const {
  return {usual_off(), field_.seen.at(field_.grid, surface + normal * usual_off())};
}

void FogLight::weaken(const PreparedScene& scene, const LightTable& clear,
                      const std::vector<std::uint32_t>& pieces, LightTable& out) {
  std::vector<std::size_t> first;
  std::size_t count = 0;
  for (const PlacedMesh& placed : scene.placed) {
    first.push_back(count);
    if (!placed.moves) count += scene.meshes[placed.mesh].bake_points.size();
  }
  pool_.run(int(pieces.size()), 1, [&](int begin, int end) {
    for (int at = begin; at < end; ++at) {
      const std::size_t k = pieces[std::size_t(at)];
      const PlacedMesh& placed = scene.placed[k];
      const PreparedMesh& mesh = scene.meshes[placed.mesh];
      std::vector<Change> changes;
      for (std::size_t i = 0; i < mesh.bake_points.size(); ++i) {
        const BakePoint& point = mesh.bake_points[i];
        const Vec3f p(placed.world_from_mesh * (Vec3(point.position) * placed.scale));
        const Vec3f n(placed.world_from_mesh.rotation.rotate(Vec3(point.normal)));
        changes.push_back(change_at(p, n, placed.moves ? place_of_mover(p, n) : places_[first[k] + i]));
      }
      for (std::size_t i = 0; i < mesh.light_nodes.size(); ++i) {
        const LightNode& node = mesh.light_nodes[i];
        const Vec3f n(placed.world_from_mesh.rotation.rotate(Vec3(node.normal)));
        Vec3f factor, air;
        for (std::size_t w = 0; w < node.points.size(); ++w) {
          const Change& change = changes[node.points[w]];
          factor += change.factor * node.weights[w], air += change.air * node.weights[w];
        }
        UnpackedLight light = unpack_light(clear[placed.first_light + i], n);
        const float strength = luminance(light.colour);
        for (int c = 0; c < 3; ++c) light.colour[c] *= factor[c];
        if (strength > 0) light.vector = light.vector * (luminance(light.colour) / strength);
        out[placed.first_light + i] = pack_light(light.vector + n * luminance(air), light.colour + air);
      }
    }
  });
}

void FogLight::set_lamp(const LampReach& reach, const Radiance& radiance) {
  const PlacedLamp& lamp = reach.lamp();
  AirTransfer::Sources sources;
  sources.surfaces = radiance.data(), sources.brighter = true;
  sources.tolerance = kLampTolerance, sources.most = kLampIterations;
  const AirGrid& grid = field_.grid;
  sources.direct.resize(grid.count());
  const float cell = transfer_.links().cell();
  pool_.run(int(grid.count()), 256, [&](int begin, int end) {
    for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i) {
      const Vec3f p = grid.point(i), way = lamp.position - p;
      const float away = std::max(norm(way), 1e-3f);
      if (away > LampReach::kReach || !(away <= 1e-3f || reach.shines_on(p - lamp.position, away))) continue;
      const Vec3f to_lamp = way * (1 / away);
      // The mean over what the point stands for: next to the lamp the square of the distance is that of a cell.
      const float spread = away * away / (away * away + 0.1f * cell * cell);
      const auto passed = float(quick::exp(-air_.turned_depth(Vec3(p), Vec3(to_lamp), double(away))));
      add_beam(lamp.illuminance(lamp.position, p) * (spread * passed), to_lamp, sources.direct[i]);
    }
  });
  lamp_ = transfer_.solve(matter_, sources, pool_);
  add_up();
}

LampAir FogLight::air_of_device() const {
  LampAir out;
  out.links = &transfer_.links(), out.matter = &matter_, out.matter_version = matter_version_, out.off = usual_off();
  out.tolerance = float(kLampTolerance), out.most_iterations = kLampIterations;
  return out;
}

void FogLight::put_lamp_out() {
  if (lamp_.air.empty()) return;
  lamp_ = {};
  add_up();
}

float FogLight::daylight(const Vec3f& point) const {
  const AirGrid::Corners corners = day_.shown(field_.grid.about(field_.grid.nearest(point)));
  const Vec3f first = blend_in_stops(day_.ends, corners)[0] + blend_in_stops(day_.air, corners)[0];
  return luminance(first) * (harmonics_of({0, 0, 1})[0] * portable::kPiF);
}

Vec3f FogLight::lamp_illuminance(const Vec3f& point, const Vec3f& normal) const {
  if (lamp_.air.empty()) return {};
  const AirGrid& grid = field_.grid;
  const float off = usual_off();
  const Vec3f p = point + normal * off;
  if (norm(p - grid.nearest(p)) > off) return {};
  return illuminance_between(lamp_.air, lamp_.shown(grid.about(p)), normal, false);
}

}  // namespace rubble
