#include "render/transport/fog_light.h"

#include <algorithm>
#include <cmath>

#include "render/lighting/light_packing.h"
#include "render/media/air_box.h"

namespace rubble {

namespace {

constexpr float kMostFactor = 4;  // of what fog does to baked light
constexpr float kLampReach = 10;  // beyond which the lamp's light is left out, as in lamp_bounce.cpp; unit: m
constexpr int kLampIterations = 12;

void add_beam(const Vec3f& illuminance, const Vec3f& to_light, RadianceTerms& out) {
  const Harmonics y = harmonics_of(to_light);
  for (std::size_t t = 0; t < kHarmonics; ++t) out[t] += illuminance * y[t];
}

// Share of a light's beam that passes to p.
float passes_to(const Air& air, const Aabb& box, const LightModel& light, const LightModel::Sample& sample, const Vec3f& p) {
  float near = 0, far = sample.distance;
  if (light.type == LightType::directional && !clip_to_box(box, p, sample.to_light, near, far)) return 1;
  return float(std::exp(-air.turned_depth(Vec3(p + sample.to_light * near), Vec3(sample.to_light), double(far - near))));
}

}  // namespace

FogLight::FogLight(const PreparedScene& scene, const RayScene& rays, const Aabb& box, const LightSet& light,
                   Radiance radiance, int threads)
    : box_(box),
      light_(light),
      radiance_(std::move(radiance)),
      pool_(std::max(1, threads)),
      transfer_(make_air_links(scene, rays, box, threads)) {
  const AirGrid& grid = transfer_.links().grid;
  for (const Vec3f& d : transfer_.links().directions) sky_.push_back(d.z > 0 ? light_.sky.radiance(d) : Vec3f());
  for (const LightModel& model : light_.lights) {
    std::vector<std::uint8_t>& lit = lit_.emplace_back(grid.count());
    pool_.run(int(grid.count()), 64, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        const Vec3f p = grid.point(std::size_t(i));
        const LightModel::Sample sample = model.at(p);
        lit[std::size_t(i)] = !rays.blocked(p, sample.to_light, 0, std::min(sample.distance * 0.999f, kLightReach));
      }
    });
  }
  AirTransfer::Sources sources;
  sources.sky = sky_.data(), sources.surfaces = radiance_.data();
  find_direct(nullptr, sources.direct);
  AirMatter none;
  none.extinction.resize(grid.count()), none.scattered.resize(grid.count());
  clear_ = transfer_.solve(none, sources, pool_).ends;
  for (std::size_t i = 0; i < clear_.size(); ++i)
    usual_.push_back((clear_[i][0] + sources.direct[i][0]) * harmonics_of({0, 0, 1})[0]);
  field_.grid = grid;
  find_open();
}

// air: none: clear.
void FogLight::find_direct(const Air* air, std::vector<RadianceTerms>& out) {
  const AirGrid& grid = transfer_.links().grid;
  out.assign(grid.count(), {});
  for (std::size_t l = 0; l < light_.lights.size(); ++l) {
    const LightModel& model = light_.lights[l];
    pool_.run(int(grid.count()), 256, [&](int begin, int end) {
      for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i) {
        if (!lit_[l][i]) continue;
        const Vec3f p = grid.point(i);
        const LightModel::Sample sample = model.at(p);
        add_beam(sample.illuminance * (air ? passes_to(*air, box_, model, sample, p) : 1.0f), sample.to_light, out[i]);
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
  matter_ = turning_matter(air, transfer_.links().grid);
  AirTransfer::Sources sources;
  sources.sky = sky_.data(), sources.surfaces = radiance_.data(), sources.usual = usual_;
  find_direct(&air_, sources.direct);
  day_ = transfer_.solve(matter_, sources, pool_);
  add_up();
}

void FogLight::add_up() {
  field_.terms = day_.ends;
  const auto add = [&](const std::vector<RadianceTerms>& more) {
    for (std::size_t i = 0; i < more.size(); ++i)
      for (std::size_t t = 0; t < kHarmonics; ++t) field_.terms[i][t] += more[i][t];
  };
  add(day_.air), add(lamp_.ends);
  field_.of_lamp = lamp_.air;
}

std::vector<BakedLight> FogLight::weaken(const PreparedScene& scene, const std::vector<BakedLight>& clear) {
  std::vector<BakedLight> out = clear;
  const AirGrid& grid = field_.grid;
  const float off = 0.5f * std::min(grid.cell.x, std::min(grid.cell.y, grid.cell.z));
  pool_.run(int(scene.placed.size()), 1, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      const PlacedMesh& placed = scene.placed[std::size_t(k)];
      const std::vector<LightNode>& nodes = scene.meshes[placed.mesh].light_nodes;
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Vec3f n(placed.world_from_mesh.rotation.rotate(Vec3(nodes[i].normal)));
        const Vec3f p = Vec3f(placed.world_from_mesh * (Vec3(nodes[i].position) * placed.scale)) + n * off;
        if (!(norm(p - grid.nearest(p)) <= off)) continue;  // outside the box
        const AirGrid::Corners corners = grid.about(p);
        const Vec3f before = illuminance_of(blend(clear_, corners), n), ends = illuminance_of(blend(day_.ends, corners), n);
        const Vec3f air = illuminance_of(blend(day_.air, corners), n);
        UnpackedLight light = unpack_light(clear[placed.first_light + i], n);
        const float strength = luminance(light.colour);
        for (int c = 0; c < 3; ++c)
          light.colour[c] = light.colour[c] * (before[c] > 0 ? std::min(ends[c] / before[c], kMostFactor) : 1.0f);
        if (strength > 0) light.vector = light.vector * (luminance(light.colour) / strength);
        out[placed.first_light + i] = pack_light(light.vector + n * luminance(air), light.colour + air);
      }
    }
  });
  return out;
}

void FogLight::set_lamp(const PlacedLamp& lamp, const Radiance& radiance, const std::function<bool(const Vec3f&)>& sees) {
  AirTransfer::Sources sources;
  sources.surfaces = radiance.data(), sources.brighter = true;
  sources.tolerance = 0.02, sources.most = kLampIterations;
  const AirGrid& grid = field_.grid;
  sources.direct.resize(grid.count());
  const float cell = std::min(grid.cell.x, std::min(grid.cell.y, grid.cell.z));
  pool_.run(int(grid.count()), 256, [&](int begin, int end) {
    for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i) {
      const Vec3f p = grid.point(i), way = lamp.position - p;
      const float away = std::max(norm(way), 1e-3f);
      if (away > kLampReach || !sees(p)) continue;
      const Vec3f to_lamp = way * (1 / away);
      // The mean over what the point stands for: next to the lamp the square of the distance is that of a cell.
      const float spread = away * away / (away * away + 0.1f * cell * cell);
      const auto passed = float(std::exp(-air_.turned_depth(Vec3(p), Vec3(to_lamp), double(away))));
      add_beam(lamp.illuminance(lamp.position, p) * (spread * passed), to_lamp, sources.direct[i]);
    }
  });
  lamp_ = transfer_.solve(matter_, sources, pool_);
  add_up();
}

void FogLight::put_lamp_out() {
  if (lamp_.air.empty()) return;
  lamp_ = {};
  add_up();
}

float FogLight::daylight(const Vec3f& point) const {
  const AirGrid::Corners corners = field_.grid.about(field_.grid.nearest(point));
  const Vec3f first = blend(day_.ends, corners)[0] + blend(day_.air, corners)[0];
  return luminance(first) * (harmonics_of({0, 0, 1})[0] * portable::kPiF);
}

Vec3f FogLight::lamp_illuminance(const Vec3f& point, const Vec3f& normal) const {
  if (lamp_.air.empty()) return {};
  const AirGrid& grid = field_.grid;
  const float off = 0.5f * std::min(grid.cell.x, std::min(grid.cell.y, grid.cell.z));
  const Vec3f p = point + normal * off;
  if (norm(p - grid.nearest(p)) > off) return {};
  return illuminance_of(blend(lamp_.air, grid.about(p)), normal);
}

}  // namespace rubble
