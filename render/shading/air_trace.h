// How much light the air lets pass up to each distance before a camera, and how much it throws towards the lens on the
// way: the formulas of media/medium.h and media/air_glow.h for several rays at a time.
#pragma once

#include "render/shading/air_trace_data.h"
#include "render/shading/contact.h"
#include "render/shading/fog_depth.h"

namespace rubble::RUBBLE_ISA {

RUBBLE_INLINE Real3 all_lanes(const float (&v)[3]) { return {real(v[0]), real(v[1]), real(v[2])}; }
RUBBLE_INLINE Real3 first_three(const Row& r) { return {as_real(r.x), as_real(r.y), as_real(r.z)}; }

// 1 - e^-x for x of 0 and above, also where that is next to nothing.
RUBBLE_INLINE Real lost(Real x) {
  return select(x < 0.02f, x * (1.0f - x * (0.5f - x * (1.0f / 6 - x * (1.0f / 24)))), 1.0f - exp(-x));
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

// Abramowitz and Stegun 4.4.46, within 1e-7.
RUBBLE_INLINE Real acos(Real x) {
  const Real a = min(abs(x), 1.0f);
  Real p = a * -0.0012624911f + 0.0066700901f;
  p = p * a - 0.0170881256f;
  p = p * a + 0.0308918810f;
  p = p * a - 0.0501743046f;
  p = p * a + 0.0889789874f;
  p = p * a - 0.2145988016f;
  p = p * a + 1.5707963050f;
  const Real angle = sqrt(1.0f - a) * p;
  return select(x < 0.0f, 3.14159265f - angle, angle);
}

// Henyey and Greenstein, as phase_function().
RUBBLE_INLINE Real phase(float g, Real cosine) {
  const Real base = 1.0f + g * g - 2.0f * g * cosine;
  return (1.0f - g * g) * 0.0795774715f / (base * sqrt(base));
}

// What scatters light at a point: shares of fog, of dust and of drops; as Scatterer.
struct Scattering {
  const AirTraceData& d;
  Real fog, dust, drops;

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
    return 1.0f - d.albedo * (fog * forward(d.fog_g) + dust * forward(d.dust_g) + drops * forward(d.drops_g));
  }
  // What scattering leaves of each order: of all, and of what does not go nearly straight on.
  RUBBLE_INLINE void orders(Real (&out)[4]) const { powers(fog, dust, drops, d.fog_g, d.dust_g, d.drops_g, out); }
  RUBBLE_INLINE void orders_less(Real (&out)[4]) const {
    powers(fog * (1 - forward(d.fog_g)), dust * (1 - forward(d.dust_g)), drops * (1 - forward(d.drops_g)),
           turned(d.fog_g), turned(d.dust_g), turned(d.drops_g), out);
  }

 private:
  RUBBLE_INLINE static void powers(Real a, Real b, Real c, float x, float y, float z, Real (&out)[4]) {
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
inline void add_dust(const AirTraceData& d, const Real3& eye, const Real3& way, int slices, Real* dust) {
  constexpr float kWidest = 4.5f;  // as in media/medium.cpp
  for (int i = 0; i < d.puff_count; ++i) {
    const AirTraceData::Puff& puff = d.puffs[i];
    const Real3 off = eye - all_lanes(puff.centre);
    const Real along = dot(off, way), aside2 = max(dot(off, off) - along * along, 0.0f);
    const float s = puff.deviation, inverse = 1 / s;
    const Mask near_ray = aside2 <= kWidest * kWidest * s * s;
    if (!any(near_ray)) continue;
    const Real strength = select(near_ray, puff.extinction * s * 1.2533141f * exp(aside2 * (-0.5f * inverse * inverse)), real(0));
    const auto edge = [&](int slice) { return clamp((d.distance[slice] + along) * inverse, -kWidest, kWidest); };
    Real before = erf(edge(0) * 0.70710678f);
    for (int slice = 1; slice < slices; ++slice) {
      const Real after = erf(edge(slice) * 0.70710678f);
      dust[slice] += strength * max(after - before, 0.0f);
      before = after;
    }
  }
}

// The part between two distances of a ray that lies in the box.
RUBBLE_INLINE Mask clip_to_box(const AirTraceData& d, const Real3& from, const Real3& way, Real& near, Real& far) {
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
  Int first[3];
  Real share[3];
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
  Real3 to_light, illuminance;
  Real distance;
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
RUBBLE_INLINE Real3 light_glow(const AirTraceData& d, const Scattering& s, const Real3& p, const Real3& way) {
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
      arriving = select(through, read_grid(d, grid, place_in_grid(d, p + beam.to_light * near)), beam.illuminance);
    } else {
      arriving = read_grid(d, grid, place_in_grid(d, p));
      if (any(s.drops > 0.0f)) {
        // Of what arrives at the border of the baked air, what is left farther away: fog hides what is there, drops do not.
        const Real border = grey_of(beam_at(light, nearest_in_grid(d, p)).illuminance);
        const Real share = min(grey_of(beam.illuminance) / max(border, 1e-20f), 1.0f);
        arriving *= select(s.drops > 0.0f, select(border > 0.0f, share, real(0)), real(1));
      }
    }
    const Mask lit = arriving.y > 0.0f;
    if (!any(lit)) continue;
    const Real3 from = p + beam.to_light * near;
    const Real depth = fog_depth(d.fog_density, d.fog_rate, from.z, beam.to_light.z, far - near) * d.beam_fog +
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

// Light of the lamp that is scattered at p towards the lens, over the lamp's colour; as lamp_glow().
RUBBLE_INLINE Real lamp_glow(const AirTraceData& d, const Scattering& s, const Real3& p, const Real3& way, Real depth) {
  const Real3 from = p - all_lanes(d.lamp_position);
  const Real d2 = max(dot(from, from), d.lamp_size2), inverse = inverse_sqrt(d2);
  const Real x = (1.0f - dot(from, all_lanes(d.lamp_axis)) * inverse) * d.lamp_cone;
  return exp2(-x * x - depth * 1.44269504f) / d2 * s.towards(-dot(from, way) * inverse);
}

// Between the rays that were looked up; light of the place or of the lamp, by colour and order.
struct Around {
  Row colour[3];

  // By what scattering leaves of each order.
  RUBBLE_INLINE Real3 scattered(const Real (&left)[4]) const {
    const auto sum = [&](const Row& r) {
      return max(as_real(r.x) * left[0] + as_real(r.y) * left[1] + as_real(r.z) * left[2] + as_real(r.w) * left[3], 0.0f);
    };
    return {sum(colour[0]), sum(colour[1]), sum(colour[2])};
  }
};

struct AroundPlace {
  Int first;  // entry of the coarser table, in its first slice
  Real u, v;
};

RUBBLE_INLINE Around read_around(const AirTraceData& d, const AroundPlace& place, int slice, int part) {
  const Int first = place.first + slice * d.around_rows * d.around_columns;
  Around out;
  for (int c = 0; c < 3; ++c) {
    const auto entry = [&](int offset) { return load_rows(d.around, (first + offset) * 6 + (part * 3 + c)); };
    const Row a = entry(0), b = entry(1), e = entry(d.around_columns), f = entry(d.around_columns + 1);
    const auto between = [&](Word Row::*m) {
      return Word(mix(mix(as_real(a.*m), as_real(b.*m), place.u), mix(as_real(e.*m), as_real(f.*m), place.u), place.v));
    };
    out.colour[c] = {between(&Row::x), between(&Row::y), between(&Row::z), between(&Row::w)};
  }
  return out;
}

RUBBLE_INLINE AroundPlace place_around(const AirTraceData& d, Int column, Int row) {
  const auto place = [&](Int i, int count, Real& share) {
    const Real at = clamp((to_real(i) + 0.5f) / float(d.shared) - 0.5f, 0.0f, float(count - 1));
    const Int low = min(to_int(at), integer(count - 2));
    share = at - to_real(low);
    return low;
  };
  AroundPlace out;
  const Int x = place(column, d.around_columns, out.u), y = place(row, d.around_rows, out.v);
  out.first = y * d.around_columns + x;
  return out;
}

// Spherical harmonics to the third order, as harmonics_of().
RUBBLE_INLINE void harmonics_of(const Real3& v, Real (&out)[16]) {
  const Real x = v.x, y = v.y, z = v.z, z2 = z * z;
  out[0] = real(0.2820948f), out[1] = 0.4886025f * y, out[2] = 0.4886025f * z, out[3] = 0.4886025f * x;
  out[4] = 1.0925484f * x * y, out[5] = 1.0925484f * y * z, out[6] = 0.3153916f * (3.0f * z2 - 1.0f);
  out[7] = 1.0925484f * x * z, out[8] = 0.5462742f * (x * x - y * y);
  out[9] = 0.5900436f * y * (3.0f * x * x - y * y), out[10] = 2.8906114f * x * y * z;
  out[11] = 0.4570458f * y * (5.0f * z2 - 1.0f), out[12] = 0.3731763f * z * (5.0f * z2 - 3.0f);
  out[13] = 0.4570458f * x * (5.0f * z2 - 1.0f), out[14] = 1.4453057f * z * (x * x - y * y);
  out[15] = 0.5900436f * x * (x * x - 3.0f * y * y);
}

// Light that is scattered twice next to the lamp, by what scattering leaves of each order; as NearGlow::at().
inline Real near_glow(const AirTraceData& d, const Real3& p, const Real3& direction, const Real (&less)[4]) {
  const Real3 axis = all_lanes(d.lamp_axis), way = p - all_lanes(d.lamp_position);
  const Real r2 = max(dot(way, way), d.lamp_size2), along = dot(way, axis);
  const Real missing = inverse_sqrt(r2) - inverse_sqrt(r2 + d.near_glow_cell * d.near_glow_cell);
  const Real cosine = clamp(along * inverse_sqrt(r2), -1.0f, 1.0f);
  const Real3 aside = way - axis * along;
  const Real off = length(aside);
  const Real3 level = cross(axis, std::fabs(d.lamp_axis[2]) < 0.9f ? Real3{real(0), real(0), real(1)}
                                                                  : Real3{real(1), real(0), real(0)});
  const Real3 x = select(off < 1e-6f, normalize(level), aside * (1.0f / max(off, 1e-6f))), y = cross(axis, x);
  Real terms[16];
  harmonics_of({dot(direction, x), dot(direction, y), dot(direction, axis)}, terms);
  const Real at = acos(cosine) * (float(d.near_glow_steps) / 3.14159265f);
  const Int low = min(to_int(at), integer(d.near_glow_steps - 1));
  const Real part = at - to_real(low);
  constexpr int kOrder[16] = {0, 1, 1, 1, 2, 2, 2, 2, 2, 3, 3, 3, 3, 3, 3, 3};
  Real sum = real(0);
  for (int four = 0; four < 4; ++four) {
    const Row a = load_rows(d.near_glow, low * 4 + four), b = load_rows(d.near_glow, low * 4 + (4 + four));
    const auto add = [&](Word from, Word to, int t) {
      sum += mix(as_real(from), as_real(to), part) * terms[t] * less[kOrder[t]];
    };
    add(a.x, b.x, four * 4), add(a.y, b.y, four * 4 + 1), add(a.z, b.z, four * 4 + 2), add(a.w, b.w, four * 4 + 3);
  }
  return max(sum * missing, 0.0f);
}

inline void store_entries(const AirTraceData& d, int column, int row, int slice, const Real3& glow, Real passed) {
  for (int lane = 0; lane < kWidth; ++lane) {
    float* at = d.table + ((std::ptrdiff_t(slice) * d.rows + row + (lane >> 2)) * d.columns + column + (lane & 3)) * 4;
    at[0] = glow.x[lane], at[1] = glow.y[lane], at[2] = glow.z[lane], at[3] = passed[lane];
  }
}

struct AirRays {
  Real3 eye, way;
  Real box_near, box_far;
  Mask through;  // the box
  AroundPlace around;
};

// What has come together on the way so far.
struct AirSum {
  Real3 glow{};
  Real depth{}, turned_depth{};  // the latter as Air::turned_depth(), but for what is scattered straight on outside the box
};

inline void add_slice(const AirTraceData& d, const AirRays& rays, int slice, Real dust, AirSum& sum) {
  const float near = d.distance[slice - 1], far = d.distance[slice], at = 0.5f * (near + far);
  const Real3 middle = rays.eye + rays.way * real(at);
  const Real mist = fog_depth(d.fog_density, d.fog_rate, rays.eye.z + rays.way.z * near, rays.way.z, real(far - near));
  const Real drops = real(d.drops[slice]), all = mist + dust + drops;
  const Mask there = all > 1e-9f;
  if (!any(there)) return;
  const Real inverse = 1.0f / max(all, 1e-12f);
  const Scattering s{d, mist * inverse, dust * inverse, drops * inverse};
  const Real step = select(there, (mist + dust) * billows_at(d, middle) + drops, real(0));
  Real orders[4], less[4];
  s.orders(orders), s.orders_less(less);
  const Real3 source = light_glow(d, s, middle, rays.way) +
                       (d.around ? read_around(d, rays.around, slice, 0).scattered(orders) : even_glow(d, s, middle));
  sum.glow += source * (exp(-sum.depth) * lost(step) * d.albedo);
  // The lamp's light goes the same way out and back. Most of what is scattered nearly straight on stays in its beam and
  // in the camera's ray, so both are weakened by what is turned alone; how much is thrown back is by the whole phase
  // function (Nakajima and Tanaka 1988).
  const Mask inside = rays.through & Mask(at > rays.box_near) & Mask(at < rays.box_far);
  const Real turned_step = select(inside, step * s.turned_share(), step);
  const Real left = exp(-sum.turned_depth);
  const Real share = select(turned_step > 0.0f, left * lost(turned_step) * step / max(turned_step, 1e-20f) * d.albedo, real(0));
  if (d.lamp) {
    // Next to the lamp its light varies within a slice.
    const int parts = near < 0.5f ? 4 : near < 2 ? 2 : 1;
    Real once = real(0);
    for (int i = 0; i < parts; ++i) {
      const float part = (float(i) + 0.5f) / float(parts);
      once += lamp_glow(d, s, rays.eye + rays.way * real(near + (far - near) * part), rays.way, sum.turned_depth + part * turned_step);
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
  const auto part = [&](int i) { return gather(d.rays + std::ptrdiff_t(i) * d.columns * d.rows, ray); };
  AirRays rays{{part(0), part(1), part(2)}, {part(3), part(4), part(5)}, real(0), real(d.distance[d.slices - 1]), {}, {}};
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
