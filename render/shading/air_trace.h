// How much light the air lets pass up to each distance before a camera, and how much it throws
// towards the lens on the way, for several rays at a time.
#pragma once

#include "render/shading/air_around.h"
#include "render/shading/air_lights.h"
#include "render/shading/contact.h"

namespace rubble::RUBBLE_ISA {

inline void store_entries(const AirTraceData& d, int column, int row, int slice, const Real3& glow,
                          Real passed) {
  for (int lane = 0; lane < kWidth; ++lane) {
    float* at = d.table + ((std::ptrdiff_t(slice) * d.rows + row + (lane >> 2)) * d.columns +
                           column + (lane & 3)) *
                              4;
    at[0] = glow.x[lane], at[1] = glow.y[lane], at[2] = glow.z[lane], at[3] = passed[lane];
  }
}

struct AirRays {
  Real3 eye, way;          // where they start, and their unit directions
  Real box_near, box_far;  // between which they are in the box; unit: m
  Mask through;            // the box
  AroundPlace around;      // of the looked-up rays about them
};

// What has come together on the way so far.
struct AirSum {
  Real3 glow{};                  // thrown towards the lens; unit: kcd/m2
  Real depth{}, turned_depth{};  // the latter as Air::turned_depth(), but for what is scattered
                                 // straight on outside the box
};

inline void add_slice(const AirTraceData& d, const AirRays& rays, int slice, Real dust,
                      AirSum& sum) {
  const float near = d.distance[slice - 1], far = d.distance[slice], at = 0.5f * (near + far);
  const Real3 middle = rays.eye + rays.way * real(at);
  const Real mist = fog_depth(d.fog_density, d.fog_rate, rays.eye.z + rays.way.z * near, rays.way.z,
                              real(far - near));
  const Real drops = real(d.drops[slice]), all = mist + dust + drops;
  const Mask there = all > 1e-9f;
  if (!any(there)) return;
  const Real inverse = 1.0f / max(all, 1e-12f);
  const Scattering s{d, mist * inverse, dust * inverse, drops * inverse};
  const Real step = select(there, (mist + dust) * billows_at(d, middle) + drops, real(0));
  Real orders[4], less[4];
  s.orders(orders), s.orders_less(less);
  const Real3 source = light_glow(d, s, middle, rays.way) +
                       (d.around ? read_around(d, rays.around, slice, 0).scattered(orders)
                                 : even_glow(d, s, middle));
  sum.glow += source * (exp(-sum.depth) * lost(step) * d.albedo);
  // The lamp's light goes the same way out and back. Most of what is scattered nearly straight on
  // stays in its beam and in the camera's ray, so both are weakened by what is turned alone; how
  // much is thrown back is by the whole phase function (Nakajima and Tanaka 1988).
  const Mask inside = rays.through & Mask(at > rays.box_near) & Mask(at < rays.box_far);
  const Real turned_step = select(inside, step * s.turned_share(), step);
  const Real left = exp(-sum.turned_depth);
  const Real share =
      select(turned_step > 0.0f,
             left * lost(turned_step) * step / max(turned_step, 1e-20f) * d.albedo, real(0));
  if (d.lamp) {
    // Next to the lamp its light varies within a slice.
    const int parts = near < 0.5f ? 4 : near < 2 ? 2 : 1;
    Real once = real(0);
    for (int i = 0; i < parts; ++i) {
      const float part = (float(i) + 0.5f) / float(parts);
      once += lamp_glow(d, s, rays.eye + rays.way * real(near + (far - near) * part), rays.way,
                        sum.turned_depth + part * turned_step);
    }
    Real of_colour = once * share * (1.0f / float(parts));
    if (d.near_glow && near < d.near_glow_reach && any(inside)) {
      const Real scattering = d.albedo * less[0] * step * (1.0f / (far - near));
      const Real again = near_glow(d, middle, rays.way, less) * scattering * left * share;
      of_colour += select(inside, again, real(0));
    }
    sum.glow += all_lanes(d.lamp_colour) * of_colour;
  }
  if (d.around) sum.glow += read_around(d, rays.around, slice, 1).scattered(less) * share;
  sum.depth += step, sum.turned_depth += turned_step;
}

inline void trace_block(const AirTraceData& d, int column, int row) {
  const Int x = lane_columns() + column, y = lane_rows() + row, ray = y * d.columns + x;
  const auto part = [&](int i) {
    return gather(d.rays + std::ptrdiff_t(i) * d.columns * d.rows, ray);
  };
  AirRays rays{{part(0), part(1), part(2)},
               {part(3), part(4), part(5)},
               real(0),
               real(d.distance[d.slices - 1]),
               {},
               {}};
  rays.through = clip_to_box(d, rays.eye, rays.way, rays.box_near, rays.box_far);
  if (d.around) rays.around = place_around(d, x, y);
  int slices = 1;
  for (int lane = 0; lane < kWidth; ++lane) {
    const int wanted = d.wanted[ray[lane]];
    slices = wanted > slices ? wanted : slices;
  }
  Real dust[AirTraceData::kMostSlices] = {};
  if (d.puff_count > 0) add_dust(d, rays.eye, rays.way, slices, dust);
  AirSum sum;
  store_entries(d, column, row, 0, sum.glow, real(1));
  for (int slice = 1; slice < slices; ++slice) {
    add_slice(d, rays, slice, dust[slice], sum);
    store_entries(d, column, row, slice, sum.glow, exp(-sum.depth));
  }
}

// Rows [first, last) of blocks of four rows of rays.
inline void trace_air(const AirTraceData& d, int first, int last) {
  for (int row = first * 4; row < last * 4; row += kLaneRows)
    for (int column = 0; column < d.columns; column += 4) trace_block(d, column, row);
}

}  // namespace rubble::RUBBLE_ISA
