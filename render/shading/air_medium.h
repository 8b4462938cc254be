// What hangs in the air along several rays: the formulas of media/medium.h and of Scatterer in
// media/air_glow.h.
#pragma once

#include "render/shading/air_trace_data.h"
#include "render/shading/fog_depth.h"

namespace rubble::RUBBLE_ISA {

RUBBLE_INLINE Real3 all_lanes(const float (&v)[3]) { return {real(v[0]), real(v[1]), real(v[2])}; }
RUBBLE_INLINE Real3 first_three(const Row& r) { return {as_real(r.x), as_real(r.y), as_real(r.z)}; }

// 1 - e^-x for x of 0 and above, also where that is next to nothing.
RUBBLE_INLINE Real lost(Real x) {
  return select(x < 0.02f, x * (1.0f - x * (0.5f - x * (1.0f / 6 - x * (1.0f / 24)))),
                1.0f - exp(-x));
}

// Abramowitz and Stegun 7.1.26, within 2e-7.
RUBBLE_INLINE Real erf(Real x) {
  const Real a = min(abs(x), 5.0f), t = 1.0f / (1.0f + 0.3275911f * a);
  Real p = t * 1.061405429f - 1.453152027f;
  p = p * t + 1.421413741f;
  p = p * t - 0.284496736f;
  p = p * t + 0.254829592f;
  const Real value = 1.0f - p * t * exp(-a * a);
  return select(x < 0.0f, -value, value);
}

// Henyey and Greenstein, as phase_function().
RUBBLE_INLINE Real phase(float g, Real cosine) {
  const Real base = 1.0f + g * g - 2.0f * g * cosine;
  return (1.0f - g * g) * 0.0795774715f / (base * sqrt(base));
}

// What scatters light at a point: shares of fog, of dust and of drops; as Scatterer.
struct Scattering {
  const AirTraceData& d;  // whose mean cosines count
  Real fog, dust, drops;  // shares; their sum is 1 where there is anything

  RUBBLE_INLINE Real towards(Real cosine) const {
    Real sum = fog * phase(d.fog_g, cosine);
    if (d.puff_count > 0) sum += dust * phase(d.dust_g, cosine);
    if (any(drops > 0.0f)) sum += drops * phase(d.drops_g, cosine);
    return sum;
  }
  // See forward_share().
  RUBBLE_INLINE static float forward(float g) { return g > 0 ? g * g : 0; }
  RUBBLE_INLINE static float turned(float g) { return g > 0 ? g / (1 + g) : g; }
  RUBBLE_INLINE Real turned_share() const {
    return 1.0f - d.albedo * (fog * forward(d.fog_g) + dust * forward(d.dust_g) +
                              drops * forward(d.drops_g));
  }
  // What scattering leaves of each order: of all, and of what does not go nearly straight on.
  RUBBLE_INLINE void orders(Real (&out)[4]) const {
    powers(fog, dust, drops, d.fog_g, d.dust_g, d.drops_g, out);
  }
  RUBBLE_INLINE void orders_less(Real (&out)[4]) const {
    powers(fog * (1 - forward(d.fog_g)), dust * (1 - forward(d.dust_g)),
           drops * (1 - forward(d.drops_g)), turned(d.fog_g), turned(d.dust_g), turned(d.drops_g),
           out);
  }

 private:
  RUBBLE_INLINE static void powers(Real a, Real b, Real c, float x, float y, float z,
                                   Real (&out)[4]) {
    for (Real& order : out) {
      order = a + b + c;
      a *= x, b *= y, c *= z;
    }
  }
};

RUBBLE_INLINE Real block_noise(const AirTraceData& d, Real x, Real y, Real z) {
  const Int last = integer(d.noise_side - 1);
  const Real fx = floor(x), fy = floor(y), fz = floor(z);
  const Int x0 = to_int(fx) & last, y0 = to_int(fy) & last, z0 = to_int(fz) & last;
  const Int x1 = (x0 + 1) & last, y1 = (y0 + 1) & last, z1 = (z0 + 1) & last;
  const auto smooth = [](Real t) { return t * t * (3.0f - 2.0f * t); };
  const Real u = smooth(x - fx), v = smooth(y - fy), w = smooth(z - fz);
  const auto row = [&](Int j, Int k) {
    const Int at = (k * d.noise_side + j) * d.noise_side;
    const Real a = gather(d.noise, at + x0);
    return a + (gather(d.noise, at + x1) - a) * u;
  };
  const Real a = row(y0, z0), b = row(y1, z0), c = row(y0, z1), e = row(y1, z1);
  return (a + (b - a) * v) * (1.0f - w) + (c + (e - c) * v) * w;
}

RUBBLE_INLINE Real billows_at(const AirTraceData& d, const Real3& p) {
  if (d.billows <= 0) return real(1);
  const Real3 q = (p - all_lanes(d.drift)) * real(d.billow_scale);
  const Real sum = block_noise(d, q.x, q.y, q.z) +
                   0.5f * block_noise(d, q.x * 2.03f + 7.7f, q.y * 2.03f, q.z * 2.03f) +
                   0.25f * block_noise(d, q.x * 4.1f, q.y * 4.1f + 3.1f, q.z * 4.1f);
  return 1.0f + d.billows * clamp(sum * 1.3f, -1.0f, 1.0f);
}

// Adds the optical depth of each slice by all puffs.
inline void add_dust(const AirTraceData& d, const Real3& eye, const Real3& way, int slices,
                     Real* dust) {
  constexpr float kWidest = 4.5f;  // as in media/medium.cpp
  for (int i = 0; i < d.puff_count; ++i) {
    const AirTraceData::Puff& puff = d.puffs[i];
    const Real3 off = eye - all_lanes(puff.centre);
    const Real along = dot(off, way), aside2 = max(dot(off, off) - along * along, 0.0f);
    const float s = puff.deviation, inverse = 1 / s;
    const Mask near_ray = aside2 <= kWidest * kWidest * s * s;
    if (!any(near_ray)) continue;
    const Real strength = select(
        near_ray, puff.extinction * s * 1.2533141f * exp(aside2 * (-0.5f * inverse * inverse)),
        real(0));
    const auto edge = [&](int slice) {
      return clamp((d.distance[slice] + along) * inverse, -kWidest, kWidest);
    };
    Real before = erf(edge(0) * 0.70710678f);
    for (int slice = 1; slice < slices; ++slice) {
      const Real after = erf(edge(slice) * 0.70710678f);
      dust[slice] += strength * max(after - before, 0.0f);
      before = after;
    }
  }
}

}  // namespace rubble::RUBBLE_ISA
