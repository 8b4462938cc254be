#include "render/media/air_volume.h"

#include <algorithm>
#include <cmath>

namespace rubble {

double AirVolume::slice_distance(int slice) {
  const double u = double(slice) / (kSlices - 1);
  return slice == kSlices - 1 ? kFarthest : std::min(kFarthest, 2 * u / (1 - u));
}

void AirVolume::build(const ViewRays& view, const Air& air, const AirLight& light,
                      const LightSet& lights, const AirLamp* lamp, bool drops_drawn, ThreadPool& pool) {
  drops_drawn_ = drops_drawn;
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
    double drops = 0;
    for (const Precipitation& kind : air_->falling())
      drops += (far - near) * (drops_drawn_ ? kind.veil(0.5 * (near + far)) : kind.extinction());
    const double all = mist + dust + drops;
    if (all > 1e-9) {
      const Scatterer scatterer{mist / all, dust / all, drops / all, air_->fog_asymmetry(), air_->dust_asymmetry()};
      const double step = (mist + dust) * air_->billows(middle) + drops;
      const double before = std::exp(-depth);
      const float share = float(before * (1 - std::exp(-step)) * air_->albedo());
      const Vec3f p(middle);
      Vec3f source = even_glow(*light_, *lights_, scatterer, p) + light_glow(*light_, *lights_, *air_, scatterer, p, Vec3f(direction));
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
