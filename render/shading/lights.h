// Light that arrives at a point, and the sky: the formulas of shaders/lighting.glsl, by the same
// names.
#pragma once

#include "render/shading/texture_reads.h"

namespace rubble::RUBBLE_ISA {

// Radiance of the sky in a direction that points up, from the octahedral map.
RUBBLE_INLINE Real3 sky_radiance(const ShadingData& data, const Real3& d) {
  const Real inverse = 1.0f / (abs(d.x) + abs(d.y) + max(d.z, 0.0f));
  const Real x = d.x * inverse, y = d.y * inverse;
  return read_sky(data, (x + y) * 0.5f + 0.5f, (x - y) * 0.5f + 0.5f);
}

// The sky as the eye meets it: with the sun's disc, and trees and roofs far away.
inline Real3 backdrop(const ShadingData& data, const Real3& d) {
  const FrameBlock& f = data.frame;
  Real3 sky = sky_radiance(data, d);
  const Real c = dot(d, all_lanes(f.sun_direction));
  sky += all_lanes(f.sun_radiance) * smoothstep(0.999985f, 0.999992f, c);
  const Mask low = abs(d.z - 0.017f) < 0.02f;  // the ridge is between 0.002 and 0.032
  Real behind = select(d.z > 0.017f, real(1), real(0));
  if (any(low)) {
    const Real inverse = inverse_sqrt(max(d.x * d.x + d.y * d.y, 1e-20f)), x = d.x * inverse,
               y = d.y * inverse;
    const Real ridge = 0.017f + 0.006f * sin(5.3f * x + 2.0f * sin(3.1f * y)) +
                       0.004f * sin(11.0f * y + 1.7f) +
                       0.0025f * sin(37.0f * x + 4.0f * sin(19.0f * y)) +
                       0.0016f * sin(120.0f * y - 70.0f * x) * sin(83.0f * x) +
                       0.0008f * sin(310.0f * x + 230.0f * y);
    const Real t = clamp((d.z - ridge) * (1.0f / 0.0016f) + 0.5f, 0.0f, 1.0f);
    behind = select(low, t * t * (3.0f - 2.0f * t), behind);
  }
  return mix(mix(all_lanes(f.skyline), sky, 0.55f + 10.0f * max(d.z, 0.0f)), sky, behind);
}

struct Arriving {
  Real3 illuminance;  // on a facing surface
  Real3 to_light;     // unit length; of the lamp shorter near it
};

RUBBLE_INLINE Arriving light_at(const ShadingData& data, int i, const Real3& p) {
  const FrameBlock& f = data.frame;
  const int type = data.lights[i].type;
  const Real3 colour = all_lanes(f.light_colour[i]), axis = all_lanes(f.light_axis[i]);
  if (type == 0) return {colour, -axis};
  const Real3 offset = all_lanes(f.light_position[i]) - p;
  const Real d2 = max(dot(offset, offset), 1e-6f);
  const Real3 to_light = offset * inverse_sqrt(d2);
  Real strength = 1.0f / d2;
  if (type == 1) {
    const Real c =
        clamp((-dot(to_light, axis) - f.light_axis[i][3]) * f.light_colour[i][3], 0.0f, 1.0f);
    strength *= c * c * (3.0f - 2.0f * c);
  }
  return {colour * strength, to_light};
}

// Intensity falls to half at the half-power angle, and a ring has no near field of a point: see
// lighting.glsl.
RUBBLE_INLINE Arriving lamp_at(const ShadingData& data, const Real3& p) {
  const FrameBlock& f = data.frame;
  const Real3 offset = all_lanes(f.lamp_position) - p;
  const Real d2 = max(dot(offset, offset), 1e-6f);
  const Real x = (1.0f + dot(offset, all_lanes(f.lamp_axis)) * inverse_sqrt(d2)) * f.lamp_axis[3];
  const Real far2 = d2 + f.lamp_position[3];
  return {all_lanes(f.lamp_colour) * (exp2(-x * x) / far2), offset * inverse_sqrt(far2)};
}

// What beams lose in the mean air along a straight line from a height z, as Air::turned_depth().
RUBBLE_INLINE Real air_depth(const ShadingData& data, Real z, Real slope, Real way) {
  const FrameBlock& f = data.frame;
  return fog_depth(f.air_low[3], f.air_high[3], z, slope, way) + f.air_drops[0] * way;
}

// Share of light i that the air lets pass: of a beam from far away all up to the box.
RUBBLE_INLINE Real air_passes(const ShadingData& data, int i, const Real3& p,
                              const Real3& to_light) {
  const FrameBlock& f = data.frame;
  Real near = real(0), far = real(1e5f);
  if (data.lights[i].type != 0) {
    far = length(all_lanes(f.light_position[i]) - p);
  } else {
    const auto axis = [&](Real way, Real at, float low, float high) {
      way = select(abs(way) < 1e-9f, real(1e-9f), way);
      const Real a = (low - at) / way, b = (high - at) / way;
      near = max(near, min(a, b)), far = min(far, max(a, b));
    };
    axis(to_light.x, p.x, f.air_low[0], f.air_high[0]);
    axis(to_light.y, p.y, f.air_low[1], f.air_high[1]);
    axis(to_light.z, p.z, f.air_low[2], f.air_high[2]);
  }
  const Real share = exp(-air_depth(data, p.z + to_light.z * near, to_light.z, far - near));
  return select(near >= far, real(1), share);
}

struct ShadowPlace {
  Real u, v, depth;  // 0 to 1
  Mask inside;       // of the map
};

// rows: of a view that is the same for all lanes.
RUBBLE_INLINE ShadowPlace place_in_beam(const float (*rows)[4], const Real3& q) {
  const Real u = times_row(rows[0], q) * 0.5f + 0.5f, v = times_row(rows[1], q) * 0.5f + 0.5f;
  const Mask inside = Mask(u >= 0.0f) & Mask(u <= 1.0f) & Mask(v >= 0.0f) & Mask(v <= 1.0f);
  return {u, v, min(times_row(rows[2], q), 1.0f), inside};
}

// Of a directional light.
RUBBLE_INLINE Real beam_visible(const ShadingData& data, int i, const Real3& p,
                                const Real3& normal) {
  const FrameBlock& f = data.frame;
  const int view = data.lights[i].first_view;
  ShadowPlace at =
      place_in_beam(&f.shadow_rows[view * 4], p + normal * real(f.light_position[i][3] * 1.6f));
  Int layer = integer(view);
  // Outside the last map nothing is in the way.
  if (data.lights[i].views > 1 && any(~at.inside)) {
    const ShadowPlace far =
        place_in_beam(&f.shadow_rows[view * 4 + 4], p + normal * real(f.light_axis[i][3] * 1.6f));
    layer = select(at.inside, layer, integer(view + 1));
    at.u = select(at.inside, at.u, far.u), at.v = select(at.inside, at.v, far.v);
    at.depth = select(at.inside, at.depth, far.depth), at.inside |= far.inside;
  }
  return select(at.inside, compare_shadow(data, at.u, at.v, layer, at.depth), real(1));
}

// 1 where light i arrives, 0 in its shadow.
inline Real light_visible(const ShadingData& data, int i, const Real3& p, const Real3& normal) {
  if (data.lights[i].type == 0) return beam_visible(data, i, p, normal);
  const FrameBlock& f = data.frame;
  const Real3 away = p - all_lanes(f.light_position[i]);
  const Real3 q = p + normal * (f.light_position[i][3] * length(away) * 1.6f + 0.002f);
  Int view = integer(data.lights[i].first_view);
  if (data.lights[i].views == 6) {
    const Real ax = abs(away.x), ay = abs(away.y), az = abs(away.z);
    const auto side = [](Real along, int face) {
      return select(along > 0.0f, integer(face), integer(face + 1));
    };
    view += select(ax >= max(ay, az), side(away.x, 0),
                   select(ay >= az, side(away.y, 2), side(away.z, 4)));
  }
  const auto along = [&](int i_row) {
    const Row r = load_rows(f.shadow_rows, view * 4 + i_row);
    return q.x * as_real(r.x) + q.y * as_real(r.y) + q.z * as_real(r.z) + as_real(r.w);
  };
  const Real w = along(3), inverse = 1.0f / max(w, 1e-12f);
  const Real lit = compare_shadow(data, along(0) * inverse * 0.5f + 0.5f,
                                  along(1) * inverse * 0.5f + 0.5f, view, along(2) * inverse);
  return select(w <= 0.0f, real(0), lit);
}

}  // namespace rubble::RUBBLE_ISA
