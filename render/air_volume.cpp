#include "render/air_volume.h"

#include <algorithm>
#include <cmath>

namespace rubble {

namespace {

constexpr float kPi = 3.14159265f;

// Light of the lamp that is scattered evenly at p towards the lens, per unit of scattering.
Vec3f lamp_glow(const AirLamp& lamp, const Vec3f& p, double depth_to_p) {
  const Vec3f from = p - lamp.position;
  const float d2 = dot(from, from);
  const float x = (1 - dot(from, lamp.axis) / std::sqrt(d2 + 1e-9f)) * lamp.cone;
  const float strength = std::exp2(-x * x) * float(std::exp(-depth_to_p));
  return lamp.colour * (strength / ((d2 + lamp.offset2) * 4 * kPi));
}

}  // namespace

double AirVolume::slice_distance(int slice) {
  const double u = double(slice) / (kSlices - 1);
  return slice == kSlices - 1 ? kFarthest : std::min(kFarthest, 2 * u / (1 - u));
}

void AirVolume::build(const ViewRays& view, const Air& air, const AirLight& light,
                      const AirLamp* lamp, ThreadPool& pool) {
  view_ = &view, air_ = &air, light_ = &light, lamp_ = lamp;
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
    double step = air_->fog_depth(eye + direction * near, direction, far - near);
    for (const DustPuff* puff : puffs) step += puff->optical_depth(eye, direction, near, far);
    if (step > 1e-9) {
      step *= air_->billows(middle);
      const double before = std::exp(-depth);
      const float share = float(before * (1 - std::exp(-step)) * air_->albedo());
      const Vec3f p(middle);
      Vec3f source = light_->at(p);
      if (lamp_) source += lamp_glow(*lamp_, p, depth + 0.5 * step);
      glow += source * share;
      depth += step;
    }
    out += slice_size;
    *out = {glow.x, glow.y, glow.z, float(std::exp(-depth))};
  }
}

}  // namespace rubble
