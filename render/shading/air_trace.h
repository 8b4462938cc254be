// The light in the air before a camera, for several rays at a time: shaders/air_medium.glsl and air_model.glsl, which are
// written once for the processor and the card.
#pragma once

#include "render/shading/air_trace_data.h"
#include "render/shading/contact.h"

namespace rubble::RUBBLE_ISA {

struct Real4 {
  Real x, y, z, w;  // a lane each
};

struct AirModel {
  const AirTraceData& d;

  RUBBLE_INLINE Real noise_value(Int i) const { return gather(d.noise, i); }
  RUBBLE_INLINE const float (&puff_place(int i) const)[4] { return d.puffs[i].place; }
  RUBBLE_INLINE float puff_extinction(int i) const { return d.puffs[i].extinction; }
  RUBBLE_INLINE Real3 baked_at(int light, Int point) const {
    const std::ptrdiff_t points = std::ptrdiff_t(d.size[0]) * d.size[1] * d.size[2];
    const Real4 row = load(light < 0 ? d.radiance : d.direct + light * points * 4, point);
    return {row.x, row.y, row.z};
  }
  RUBBLE_INLINE Real4 near_glow_row(Int i) const { return load(d.near_glow, i); }
  RUBBLE_INLINE Real4 around_row(Int i) const { return load(d.around, i); }

#define FN RUBBLE_INLINE
#define INOUT(T) T&
#define SLICES(name) Real(&name)[AirBlock::kMostSlices]
#include "render/shaders/air_medium.glsl"
#include "render/shaders/harmonics.glsl"
#include "render/shaders/air_model.glsl"
#undef SLICES
#undef INOUT
#undef FN

 private:
  RUBBLE_INLINE static Real4 load(const float* table, Int i) {
    const Row row = load_rows(table, i);
    return {as_real(row.x), as_real(row.y), as_real(row.z), as_real(row.w)};
  }
};

inline void store_entries(const AirTraceData& d, int column, int row, int slice, const Real3& glow, Real passed) {
  for (int lane = 0; lane < kWidth; ++lane) {
    float* at = d.table + ((std::ptrdiff_t(slice) * d.rows + row + (lane >> 2)) * d.columns + column + (lane & 3)) * 4;
    at[0] = glow.x[lane], at[1] = glow.y[lane], at[2] = glow.z[lane], at[3] = passed[lane];
  }
}

inline void trace_block(const AirTraceData& d, int column, int row) {
  AirModel model{d};
  const Int x = lane_columns() + column, y = lane_rows() + row, index = y * d.columns + x;
  const auto part = [&](int i) { return gather(d.rays + std::ptrdiff_t(i) * d.columns * d.rows, index); };
  const AirModel::AirRay ray = model.make_air_ray({part(0), part(1), part(2)}, {part(3), part(4), part(5)}, x, y);
  int slices = 1;
  for (int lane = 0; lane < kWidth; ++lane) {
    const int wanted = d.wanted[index[lane]];
    slices = wanted > slices ? wanted : slices;
  }
  Real dust[AirBlock::kMostSlices] = {};
  if (d.puff_count > 0) model.add_dust(ray.eye, ray.way, slices, dust);
  AirModel::AirSum sum{};
  store_entries(d, column, row, 0, sum.glow, real(1));
  for (int slice = 1; slice < slices; ++slice) {
    model.add_slice(ray, slice, dust[slice], sum);
    store_entries(d, column, row, slice, sum.glow, exp(-sum.depth));
  }
}

// Rows [first, last) of blocks of four rows of rays.
inline void trace_air(const AirTraceData& d, int first, int last) {
  for (int row = first * 4; row < last * 4; row += kLaneRows)
    for (int column = 0; column < d.columns; column += 4) trace_block(d, column, row);
}

}  // namespace rubble::RUBBLE_ISA
