// What hangs in the air along a ray, and how it scatters light: the formulas of media/medium.h and of Scatterer in
// media/air_glow.h. In the words of surface_model.glsl and fog_depth.glsl, and
//   Int, Real4         as Real; four numbers x, y, z, w
//   any(m)             whether a mask is true anywhere
//   integer(i), to_int(x), to_real(i)
//   all_lanes(v)       three of four numbers that are the same for all
//   INOUT(T)           stands before a parameter that is changed
//   SLICES(name)       such a parameter: a number for each slice
//   d                  the data, an AirBlock of shading/air_block.h
// and the tables noise_value(i), puff_place(i) with the deviation as its last number, and puff_extinction(i).

// 1 - e^-x for x of 0 and above, also where that is next to nothing.
FN Real lost(Real x) {
  return select(x < 0.02f, x * (1.0f - x * (0.5f - x * (1.0f / 6.0f - x * (1.0f / 24.0f)))), 1.0f - exp(-x));
}

// Abramowitz and Stegun 7.1.26, within 2e-7.
FN Real error_function(Real x) {
  Real a = min(abs(x), 5.0f), t = 1.0f / (1.0f + 0.3275911f * a);
  Real p = t * 1.061405429f - 1.453152027f;
  p = p * t + 1.421413741f;
  p = p * t - 0.284496736f;
  p = p * t + 0.254829592f;
  Real value = 1.0f - p * t * exp(-a * a);
  return select(x < 0.0f, -value, value);
}

// Henyey and Greenstein, as phase_function().
FN Real phase(float g, Real cosine) {
  Real base = 1.0f + g * g - 2.0f * g * cosine;
  return (1.0f - g * g) * 0.0795774715f / (base * sqrt(base));
}

// What scatters light at a point, as Scatterer: shares of fog, of dust and of drops; their sum is 1 where there is anything.
struct Scattering {
  Real fog, dust, drops;
};

FN Real scatter_towards(Scattering s, Real cosine) {
  Real sum = s.fog * phase(d.fog_g, cosine);
  if (d.puff_count > 0) sum += s.dust * phase(d.dust_g, cosine);
  if (any(s.drops > 0.0f)) sum += s.drops * phase(d.drops_g, cosine);
  return sum;
}

// See forward_share() and turned_cosine().
FN float forward_part(float g) { return g > 0.0f ? g * g : 0.0f; }
FN float turned_part(float g) { return g > 0.0f ? g / (1.0f + g) : g; }

FN Real turned_share(Scattering s) {
  return 1.0f - d.albedo * (s.fog * forward_part(d.fog_g) + s.dust * forward_part(d.dust_g) + s.drops * forward_part(d.drops_g));
}

FN Real4 sum_powers(Real a, Real b, Real c, float x, float y, float z) {
  Real4 orders;
  orders.x = a + b + c;
  a *= x, b *= y, c *= z;
  orders.y = a + b + c;
  a *= x, b *= y, c *= z;
  orders.z = a + b + c;
  a *= x, b *= y, c *= z;
  orders.w = a + b + c;
  return orders;
}

// What scattering leaves of each order of spherical harmonics: of all, and of what does not go nearly straight on.
FN Real4 orders_of_all(Scattering s) { return sum_powers(s.fog, s.dust, s.drops, d.fog_g, d.dust_g, d.drops_g); }
FN Real4 orders_less(Scattering s) {
  return sum_powers(s.fog * (1.0f - forward_part(d.fog_g)), s.dust * (1.0f - forward_part(d.dust_g)),
                    s.drops * (1.0f - forward_part(d.drops_g)), turned_part(d.fog_g), turned_part(d.dust_g),
                    turned_part(d.drops_g));
}

FN Real ease(Real t) { return t * t * (3.0f - 2.0f * t); }

FN Real noise_row(Int x0, Int x1, Int y, Int z, Real u) {
  Int at = (z * d.noise_side + y) * d.noise_side;
  Real a = noise_value(at + x0);
  return a + (noise_value(at + x1) - a) * u;
}

FN Real block_noise(Real x, Real y, Real z) {
  Int last = integer(d.noise_side - 1);
  Real fx = floor(x), fy = floor(y), fz = floor(z);
  Int x0 = to_int(fx) & last, y0 = to_int(fy) & last, z0 = to_int(fz) & last;
  Int x1 = (x0 + 1) & last, y1 = (y0 + 1) & last, z1 = (z0 + 1) & last;
  Real u = ease(x - fx), v = ease(y - fy), w = ease(z - fz);
  Real a = noise_row(x0, x1, y0, z0, u), b = noise_row(x0, x1, y1, z0, u);
  Real c = noise_row(x0, x1, y0, z1, u), e = noise_row(x0, x1, y1, z1, u);
  return (a + (b - a) * v) * (1.0f - w) + (c + (e - c) * v) * w;
}

FN Real billows_at(Real3 p) {
  if (d.billows <= 0.0f) return real(1.0f);
  Real3 q = (p - all_lanes(d.drift)) * real(d.billow_scale);
  Real sum = block_noise(q.x, q.y, q.z) + 0.5f * block_noise(q.x * 2.03f + 7.7f, q.y * 2.03f, q.z * 2.03f) +
             0.25f * block_noise(q.x * 4.1f, q.y * 4.1f + 3.1f, q.z * 4.1f);
  return 1.0f + d.billows * clamp(sum * 1.3f, -1.0f, 1.0f);
}

FN float widest_puff() { return 4.5f; }  // as in media/medium.cpp; unit: standard deviation

FN Real puff_reaches(Real along, float inverse, int slice) {
  return error_function(clamp((d.distance[slice] + along) * inverse, -widest_puff(), widest_puff()) * 0.70710678f);
}

// Adds the optical depth of each slice by all puffs.
FN void add_dust(Real3 eye, Real3 way, int slices, SLICES(dust)) {
  for (int i = 0; i < d.puff_count; ++i) {
    Real3 off = eye - all_lanes(puff_place(i));
    Real along = dot(off, way), aside2 = max(dot(off, off) - along * along, 0.0f);
    float s = puff_place(i)[3], inverse = 1.0f / s;
    Mask near_ray = aside2 <= widest_puff() * widest_puff() * s * s;
    if (!any(near_ray)) continue;
    Real strength = select(near_ray, puff_extinction(i) * s * 1.2533141f * exp(aside2 * (-0.5f * inverse * inverse)), real(0.0f));
    Real before = puff_reaches(along, inverse, 0);
    for (int slice = 1; slice < slices; ++slice) {
      Real after = puff_reaches(along, inverse, slice);
      dust[slice] += strength * max(after - before, 0.0f);
      before = after;
    }
  }
}
