// Light that single places of the air throw towards the lens: the formulas of media/air_glow.h.
#pragma once

#include "render/shading/air_medium.h"

namespace rubble::RUBBLE_ISA {

// The part between two distances of a ray that lies in the box.
RUBBLE_INLINE Mask clip_to_box(const AirTraceData& d, const Real3& from, const Real3& way,
                               Real& near, Real& far) {
  const auto axis = [&](Real at, Real along, float low, float high) {
    along = select(abs(along) < 1e-9f, real(1e-9f), along);
    const Real a = (low - at) / along, b = (high - at) / along;
    near = max(near, min(a, b)), far = min(far, max(a, b));
  };
  axis(from.x, way.x, d.box_low[0], d.box_high[0]);
  axis(from.y, way.y, d.box_low[1], d.box_high[1]);
  axis(from.z, way.z, d.box_low[2], d.box_high[2]);
  return near < far;
}

// Between the points of the baked grid, or of the border's nearest outside.
struct GridPlace {
  Int first[3];   // point below along each axis
  Real share[3];  // of the point above; 0 to 1
};

RUBBLE_INLINE GridPlace place_in_grid(const AirTraceData& d, const Real3& p) {
  GridPlace out;
  const auto axis = [&](int i, Real at) {
    const float most = float(d.size[i] - 1);
    const Real x = clamp((at - d.origin[i]) / d.cell[i], 0.0f, most);
    out.first[i] = min(to_int(x), integer(d.size[i] > 1 ? d.size[i] - 2 : 0));
    out.share[i] = x - to_real(out.first[i]);
  };
  axis(0, p.x), axis(1, p.y), axis(2, p.z);
  return out;
}

RUBBLE_INLINE Real3 read_grid(const AirTraceData& d, const float* grid, const GridPlace& at) {
  if (d.size[0] * d.size[1] * d.size[2] == 1) return {real(grid[0]), real(grid[1]), real(grid[2])};
  const Int corner = (at.first[2] * d.size[1] + at.first[1]) * d.size[0] + at.first[0];
  const auto row = [&](Int i) {
    const Real3 a = first_three(load_rows(grid, i));
    return a + (first_three(load_rows(grid, i + 1)) - a) * at.share[0];
  };
  const auto layer = [&](Int i) {
    const Real3 a = row(i);
    return a + (row(i + d.size[0]) - a) * at.share[1];
  };
  const Real3 bottom = layer(corner);
  return bottom + (layer(corner + d.size[0] * d.size[1]) - bottom) * at.share[2];
}

struct Beam {
  Real3 to_light, illuminance;  // unit length; on a facing surface without shadow; unit: klx
  Real distance;                // to the light; unit: m
};

RUBBLE_INLINE Beam beam_at(const AirTraceData::Light& light, const Real3& p) {
  const Real3 colour = all_lanes(light.colour), axis = all_lanes(light.axis);
  if (light.type == 0) return {-axis, colour, real(1e9f)};
  const Real3 offset = all_lanes(light.position) - p;
  const Real d2 = max(dot(offset, offset), 1e-6f), away = sqrt(d2);
  const Real3 to_light = offset * (1.0f / away);
  Real strength = 1.0f / d2;
  if (light.type == 1) {
    const Real c = clamp((-dot(to_light, axis) - light.cos_outer) * light.cone_width, 0.0f, 1.0f);
    strength *= c * c * (3.0f - 2.0f * c);
  }
  return {to_light, colour * strength, away};
}

// The border of the baked air nearest to a point.
RUBBLE_INLINE Real3 nearest_in_grid(const AirTraceData& d, const Real3& p) {
  const auto axis = [&](Real x, int i) {
    return clamp(x, d.origin[i], d.origin[i] + d.cell[i] * float(d.size[i] - 1));
  };
  return {axis(p.x, 0), axis(p.y, 1), axis(p.z, 2)};
}

// Of the lights that are not the lamp, as light_glow().
RUBBLE_INLINE Real3 light_glow(const AirTraceData& d, const Scattering& s, const Real3& p,
                               const Real3& way) {
  Real3 sum{real(0), real(0), real(0)};
  if (!d.direct) return sum;
  const int points = d.size[0] * d.size[1] * d.size[2];
  for (int i = 0; i < d.light_count; ++i) {
    const AirTraceData::Light& light = d.lights[i];
    const float* grid = d.direct + std::ptrdiff_t(i) * points * 4;
    const Beam beam = beam_at(light, p);
    Real near = real(0), far = beam.distance;
    Real3 arriving;
    if (light.type == 0) {
      // Outside the box the shadow is that of where the beam leaves it.
      const Mask through = clip_to_box(d, p, beam.to_light, near, far);
      near = select(through, near, real(0)), far = select(through, far, near);
      arriving = select(through, read_grid(d, grid, place_in_grid(d, p + beam.to_light * near)),
                        beam.illuminance);
    } else {
      arriving = read_grid(d, grid, place_in_grid(d, p));
      if (any(s.drops > 0.0f)) {
        // Of what arrives at the border of the baked air, what is left farther away: fog hides what
        // is there, drops do not.
        const Real border = grey_of(beam_at(light, nearest_in_grid(d, p)).illuminance);
        const Real share = min(grey_of(beam.illuminance) / max(border, 1e-20f), 1.0f);
        arriving *= select(s.drops > 0.0f, select(border > 0.0f, share, real(0)), real(1));
      }
    }
    const Mask lit = arriving.y > 0.0f;
    if (!any(lit)) continue;
    const Real3 from = p + beam.to_light * near;
    const Real depth =
        fog_depth(d.fog_density, d.fog_rate, from.z, beam.to_light.z, far - near) * d.beam_fog +
        d.beam_drops * (far - near);
    sum += arriving * (exp(-depth) * s.towards(dot(beam.to_light, way)));
  }
  return sum;
}

// Light from all around where it is not known how fog changes it, as even_glow().
RUBBLE_INLINE Real3 even_glow(const AirTraceData& d, const Scattering& s, const Real3& p) {
  const Real3 near = read_grid(d, d.radiance, place_in_grid(d, p));
  if (!d.local || d.size[0] * d.size[1] * d.size[2] == 1 || !any(s.drops > 0.0f)) return near;
  const Real3 open = all_lanes(d.open);
  const Real away = 1.0f + length(p - nearest_in_grid(d, p)) * (1 / d.half_size);
  return select(s.drops > 0.0f, open + (near - open) * (1.0f / (away * away)), near);
}

// Light of the lamp that is scattered at p towards the lens, over the lamp's colour; as
// lamp_glow().
RUBBLE_INLINE Real lamp_glow(const AirTraceData& d, const Scattering& s, const Real3& p,
                             const Real3& way, Real depth) {
  const Real3 from = p - all_lanes(d.lamp_position);
  const Real d2 = max(dot(from, from), d.lamp_size2), inverse = inverse_sqrt(d2);
  const Real x = (1.0f - dot(from, all_lanes(d.lamp_axis)) * inverse) * d.lamp_cone;
  return exp2(-x * x - depth * 1.44269504f) / d2 * s.towards(-dot(from, way) * inverse);
}

}  // namespace rubble::RUBBLE_ISA
