#include "render/media/air_volume.h"

#include <algorithm>
#include <cmath>

namespace rubble {

namespace {

// What scatters light at a point: shares of fog and of dust.
struct Scatterer {
  double fog = 1, dust = 0, fog_g = 0, dust_g = 0;
  // Light of this illuminance that goes on by an angle of this cosine, per unit of scattering.
  float phase(double cosine) const {
    return float((fog > 0 ? fog * phase_function(fog_g, cosine) : 0) +
                 (dust > 0 ? dust * phase_function(dust_g, cosine) : 0));
  }
};

// Light of the lamp that is scattered at p towards the lens, against `direction`.
Vec3f lamp_glow(const AirLamp& lamp, const Scatterer& air, const Vec3f& p, const Vec3f& direction,
                double depth_to_p) {
  const Vec3f from = p - lamp.position;
  const float d2 = std::max(dot(from, from), lamp.size2), d = std::sqrt(d2);
  const float x = (1 - dot(from, lamp.axis) / d) * lamp.cone;
  const float strength = std::exp2(-x * x) * float(std::exp(-depth_to_p)) / d2;
  return lamp.colour * (strength * air.phase(double(-dot(from, direction) / d)));
}

// Of the lights that are not the lamp. What fog takes from them on the way to p arrives there all the
// same, from all around: only the rest still has a direction.
Vec3f light_glow(const AirLight& baked, const LightSet& lights, const Air& fog, const Scatterer& air,
                 const Vec3f& p, const Vec3f& direction) {
  Vec3f sum;
  for (std::size_t i = 0; i < lights.lights.size(); ++i) {
    const Vec3f arriving = baked.direct_at(i, p);
    if (arriving == Vec3f()) continue;
    const LightModel::Sample light = lights.lights[i].at(p);
    const double way = std::min(double(light.distance), AirVolume::kFarthest);
    const auto straight = float(std::exp(-fog.fog_depth(Vec3(p), Vec3(light.to_light), way)));
    const float phase = air.phase(double(dot(light.to_light, direction)));
    sum += arriving * (straight * phase + (1 - straight) * 0.0795775f);  // 1 / (4 pi)
  }
  return sum;
}

}  // namespace

double AirVolume::slice_distance(int slice) {
  const double u = double(slice) / (kSlices - 1);
  return slice == kSlices - 1 ? kFarthest : std::min(kFarthest, 2 * u / (1 - u));
}

void AirVolume::build(const ViewRays& view, const Air& air, const AirLight& light,
                      const LightSet& lights, const AirLamp* lamp, ThreadPool& pool) {
  view_ = &view, air_ = &air, light_ = &light, lights_ = &lights, lamp_ = lamp;
  table_.resize(std::size_t(kColumns) * kRows * kSlices);
  pool.run(kRows, 2, [&](int begin, int end) {
    for (int row = begin; row < end; ++row)
      for (int column = 0; column < kColumns; ++column) trace(column, row);
  });
}

void AirVolume::trace(int column, int row) {
  const Intrinsics& k = view_->intrinsics;
  const double u = (column + 0.5) * k.width / kColumns - 0.5;
  const double v = (row + 0.5) * k.height / kRows - 0.5;
  const int pixel_u = std::clamp(int(u + 0.5), 0, k.width - 1);
  const int pixel_v = std::clamp(int(v + 0.5), 0, k.height - 1);
  const Vec3 seen = view_->directions ? view_->direction(pixel_u, pixel_v)
                                      : normalized(Vec3((u - k.cx) / k.fx, (v - k.cy) / k.fy, 1));
  const Pose world_from_optical = view_->pose(pixel_v);
  const Vec3 direction = world_from_optical.rotation.rotate(seen);
  const Vec3 eye = world_from_optical.translation;
  // Only the puffs that this ray comes near.
  std::vector<const DustPuff*> puffs;
  for (const DustPuff& puff : air_->puffs())
    if (puff.optical_depth(eye, direction, 0, kFarthest) > 1e-5) puffs.push_back(&puff);
  Vec3f glow;
  double depth = 0;
  const std::size_t slice_size = std::size_t(kColumns) * kRows;
  std::array<float, 4>* out = &table_[std::size_t(row) * kColumns + std::size_t(column)];
  *out = {0, 0, 0, 1};
  for (int slice = 1; slice < kSlices; ++slice) {
    const double near = slice_distance(slice - 1), far = slice_distance(slice);
    const Vec3 middle = eye + direction * (0.5 * (near + far));
    const double mist = air_->fog_depth(eye + direction * near, direction, far - near);
    double dust = 0;
    for (const DustPuff* puff : puffs) dust += puff->optical_depth(eye, direction, near, far);
    if (mist + dust > 1e-9) {
      const Scatterer scatterer{mist / (mist + dust), dust / (mist + dust), air_->fog_asymmetry(),
                                air_->dust_asymmetry()};
      const double step = (mist + dust) * air_->billows(middle);
      const double before = std::exp(-depth);
      const float share = float(before * (1 - std::exp(-step)) * air_->albedo());
      const Vec3f p(middle);
      Vec3f source = light_->at(p) + light_glow(*light_, *lights_, *air_, scatterer, p, Vec3f(direction));
      if (lamp_)
        source += lamp_glow(*lamp_, scatterer, p, Vec3f(direction), depth + 0.5 * step);
      glow += source * share;
      depth += step;
    }
    out += slice_size;
    *out = {glow.x, glow.y, glow.z, float(std::exp(-depth))};
  }
}

}  // namespace rubble
