// Light from all around in fog, and next to the lamp what is scattered twice: between the looked-up
// rays of media/air_volume.h, and from the table of media/near_glow.h.
#pragma once

#include "render/shading/air_medium.h"

namespace rubble::RUBBLE_ISA {

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

// Between the rays that were looked up; light of the place or of the lamp, by colour and order.
struct Around {
  Row colour[3];  // the four orders of each

  // By what scattering leaves of each order.
  RUBBLE_INLINE Real3 scattered(const Real (&left)[4]) const {
    const auto sum = [&](const Row& r) {
      return max(as_real(r.x) * left[0] + as_real(r.y) * left[1] + as_real(r.z) * left[2] +
                     as_real(r.w) * left[3],
                 0.0f);
    };
    return {sum(colour[0]), sum(colour[1]), sum(colour[2])};
  }
};

struct AroundPlace {
  Int first;  // entry of the coarser table, in its first slice
  Real u, v;  // where between it and the next along both axes; 0 to 1
};

RUBBLE_INLINE Around read_around(const AirTraceData& d, const AroundPlace& place, int slice,
                                 int part) {
  const Int first = place.first + slice * d.around_rows * d.around_columns;
  Around out;
  for (int c = 0; c < 3; ++c) {
    const auto entry = [&](int offset) {
      return load_rows(d.around, (first + offset) * 6 + (part * 3 + c));
    };
    const Row a = entry(0), b = entry(1), e = entry(d.around_columns),
              f = entry(d.around_columns + 1);
    const auto between = [&](Word Row::*m) {
      return Word(mix(mix(as_real(a.*m), as_real(b.*m), place.u),
                      mix(as_real(e.*m), as_real(f.*m), place.u), place.v));
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
  out[0] = real(0.2820948f), out[1] = 0.4886025f * y, out[2] = 0.4886025f * z,
  out[3] = 0.4886025f * x;
  out[4] = 1.0925484f * x * y, out[5] = 1.0925484f * y * z,
  out[6] = 0.3153916f * (3.0f * z2 - 1.0f);
  out[7] = 1.0925484f * x * z, out[8] = 0.5462742f * (x * x - y * y);
  out[9] = 0.5900436f * y * (3.0f * x * x - y * y), out[10] = 2.8906114f * x * y * z;
  out[11] = 0.4570458f * y * (5.0f * z2 - 1.0f), out[12] = 0.3731763f * z * (5.0f * z2 - 3.0f);
  out[13] = 0.4570458f * x * (5.0f * z2 - 1.0f), out[14] = 1.4453057f * z * (x * x - y * y);
  out[15] = 0.5900436f * x * (x * x - 3.0f * y * y);
}

// Light that is scattered twice next to the lamp, by what scattering leaves of each order; as
// NearGlow::at().
inline Real near_glow(const AirTraceData& d, const Real3& p, const Real3& direction,
                      const Real (&less)[4]) {
  const Real3 axis = all_lanes(d.lamp_axis), way = p - all_lanes(d.lamp_position);
  const Real r2 = max(dot(way, way), d.lamp_size2), along = dot(way, axis);
  const Real missing = inverse_sqrt(r2) - inverse_sqrt(r2 + d.near_glow_cell * d.near_glow_cell);
  const Real cosine = clamp(along * inverse_sqrt(r2), -1.0f, 1.0f);
  const Real3 aside = way - axis * along;
  const Real off = length(aside);
  const Real3 level =
      cross(axis, std::fabs(d.lamp_axis[2]) < 0.9f ? Real3{real(0), real(0), real(1)}
                                                   : Real3{real(1), real(0), real(0)});
  const Real3 x = select(off < 1e-6f, normalize(level), aside * (1.0f / max(off, 1e-6f))),
              y = cross(axis, x);
  Real terms[16];
  harmonics_of({dot(direction, x), dot(direction, y), dot(direction, axis)}, terms);
  const Real at = acos(cosine) * (float(d.near_glow_steps) / 3.14159265f);
  const Int low = min(to_int(at), integer(d.near_glow_steps - 1));
  const Real part = at - to_real(low);
  constexpr int kOrder[16] = {0, 1, 1, 1, 2, 2, 2, 2, 2, 3, 3, 3, 3, 3, 3, 3};
  Real sum = real(0);
  for (int four = 0; four < 4; ++four) {
    const Row a = load_rows(d.near_glow, low * 4 + four),
              b = load_rows(d.near_glow, low * 4 + (4 + four));
    const auto add = [&](Word from, Word to, int t) {
      sum += mix(as_real(from), as_real(to), part) * terms[t] * less[kOrder[t]];
    };
    add(a.x, b.x, four * 4), add(a.y, b.y, four * 4 + 1), add(a.z, b.z, four * 4 + 2),
        add(a.w, b.w, four * 4 + 3);
  }
  return max(sum * missing, 0.0f);
}

}  // namespace rubble::RUBBLE_ISA
