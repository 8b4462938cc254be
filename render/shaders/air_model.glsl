// Light in the air before a camera: how much passes up to each distance, and how much is thrown towards the lens on the
// way. The formulas of media/medium.h, media/air_glow.h and media/near_glow.h, written once in the words of
// surface_model.glsl and fog_depth.glsl: for lanes of rays by shading/air_trace.h, for the card by air_trace.comp.glsl.
// After air_medium.glsl, which has further words, and harmonics.glsl. Further tables: baked_at(light, point), where light -1 is the radiance,
// near_glow_row(i) and around_row(i).

FN Real4 mix_rows(Real4 a, Real4 b, Real t) {
  Real4 row;
  row.x = mix(a.x, b.x, t), row.y = mix(a.y, b.y, t), row.z = mix(a.z, b.z, t), row.w = mix(a.w, b.w, t);
  return row;
}

// ---- Light of the place.

FN void clip_axis(Real at, Real along, float low, float high, INOUT(Real) near, INOUT(Real) far) {
  along = select(abs(along) < 1e-9f, real(1e-9f), along);
  Real a = (low - at) / along, b = (high - at) / along;
  near = max(near, min(a, b)), far = min(far, max(a, b));
}

// The part between two distances of a ray that lies in the box.
FN Mask clip_to_box(Real3 from, Real3 way, INOUT(Real) near, INOUT(Real) far) {
  clip_axis(from.x, way.x, d.box_low[0], d.box_high[0], near, far);
  clip_axis(from.y, way.y, d.box_low[1], d.box_high[1], near, far);
  clip_axis(from.z, way.z, d.box_low[2], d.box_high[2], near, far);
  return near < far;
}

FN Int cell_below(int axis, Real at, INOUT(Real) share) {
  Real x = clamp((at - d.origin[axis]) / d.cell[axis], 0.0f, float(d.size[axis] - 1));
  Int first = min(to_int(x), integer(d.size[axis] > 1 ? d.size[axis] - 2 : 0));
  share = x - to_real(first);
  return first;
}

FN Real3 baked_row(int light, Int point, Real share) {
  Real3 a = baked_at(light, point);
  return a + (baked_at(light, point + 1) - a) * share;
}
FN Real3 baked_layer(int light, Int point, Real share_x, Real share_y) {
  Real3 a = baked_row(light, point, share_x);
  return a + (baked_row(light, point + d.size[0], share_x) - a) * share_y;
}

// Between the points of the baked grid, or of the border's nearest outside.
FN Real3 read_baked(int light, Real3 p) {
  if (d.size[0] * d.size[1] * d.size[2] == 1) return baked_at(light, integer(0));
  Real u = real(0.0f), v = real(0.0f), w = real(0.0f);
  Int x = cell_below(0, p.x, u), y = cell_below(1, p.y, v), z = cell_below(2, p.z, w);
  Int corner = (z * d.size[1] + y) * d.size[0] + x;
  Real3 bottom = baked_layer(light, corner, u, v);
  return bottom + (baked_layer(light, corner + d.size[0] * d.size[1], u, v) - bottom) * w;
}

struct Beam {
  Real3 to_light, illuminance;  // unit length; on a facing surface without shadow; unit: klx
  Real distance;                // to the light; unit: m
};

FN Beam beam_at(int light, Real3 p) {
  Real3 colour = all_lanes(d.lights[light].colour), axis = all_lanes(d.lights[light].axis);
  Beam beam;
  beam.to_light = -axis, beam.illuminance = colour, beam.distance = real(1e9f);
  if (d.lights[light].type == 0) return beam;
  Real3 offset = all_lanes(d.lights[light].position) - p;
  Real d2 = max(dot(offset, offset), 1e-6f);
  beam.distance = sqrt(d2);
  beam.to_light = offset * (1.0f / beam.distance);
  Real strength = 1.0f / d2;
  if (d.lights[light].type == 1) {
    Real c = clamp((-dot(beam.to_light, axis) - d.lights[light].cos_outer) * d.lights[light].cone_width, 0.0f, 1.0f);
    strength *= c * c * (3.0f - 2.0f * c);
  }
  beam.illuminance = colour * strength;
  return beam;
}

FN Real nearest_on_axis(Real x, int axis) {
  return clamp(x, d.origin[axis], d.origin[axis] + d.cell[axis] * float(d.size[axis] - 1));
}
// The border of the baked air nearest to a point.
FN Real3 nearest_in_grid(Real3 p) {
  return real3(nearest_on_axis(p.x, 0), nearest_on_axis(p.y, 1), nearest_on_axis(p.z, 2));
}

// Of the lights that are not the lamp, as light_glow().
FN Real3 light_glow(Scattering s, Real3 p, Real3 way) {
  Real3 sum = real3(real(0.0f), real(0.0f), real(0.0f));
  if (d.has_direct == 0) return sum;
  for (int i = 0; i < d.light_count; ++i) {
    Beam beam = beam_at(i, p);
    Real near = real(0.0f), far = beam.distance;
    Real3 arriving;
    if (d.lights[i].type == 0) {
      // Outside the box the shadow is that of where the beam leaves it.
      Mask through = clip_to_box(p, beam.to_light, near, far);
      near = select(through, near, real(0.0f)), far = select(through, far, near);
      arriving = select(through, read_baked(i, p + beam.to_light * near), beam.illuminance);
    } else {
      arriving = read_baked(i, p);
      if (any(s.drops > 0.0f)) {
        // Of what arrives at the border of the baked air, what is left farther away: fog hides what
        // is there, drops do not.
        Real border = grey_of(beam_at(i, nearest_in_grid(p)).illuminance);
        Real share = min(grey_of(beam.illuminance) / max(border, 1e-20f), 1.0f);
        arriving *= select(s.drops > 0.0f, select(border > 0.0f, share, real(0.0f)), real(1.0f));
      }
    }
    if (!any(arriving.y > 0.0f)) continue;
    Real3 from = p + beam.to_light * near;
    Real depth = fog_depth(d.fog_density, d.fog_rate, from.z, beam.to_light.z, far - near) * d.beam_fog +
                 d.beam_drops * (far - near);
    sum += arriving * (exp(-depth) * scatter_towards(s, dot(beam.to_light, way)));
  }
  return sum;
}

// Light from all around where it is not known how fog changes it, as even_glow().
FN Real3 even_glow(Scattering s, Real3 p) {
  Real3 near = read_baked(-1, p);
  if (d.local == 0 || d.size[0] * d.size[1] * d.size[2] == 1 || !any(s.drops > 0.0f)) return near;
  Real3 open = all_lanes(d.open);
  Real away = 1.0f + length(p - nearest_in_grid(p)) * (1.0f / d.half_size);
  return select(s.drops > 0.0f, open + (near - open) * (1.0f / (away * away)), near);
}

// Between the rays that were looked up; light of the place or of the lamp, by colour the four orders.
struct Around {
  Real4 colour[3];
};

FN Real scattered_of(Real4 row, Real4 left) {
  return max(row.x * left.x + row.y * left.y + row.z * left.z + row.w * left.w, 0.0f);
}
// By what scattering leaves of each order.
FN Real3 scattered(Around around, Real4 left) {
  return real3(scattered_of(around.colour[0], left), scattered_of(around.colour[1], left), scattered_of(around.colour[2], left));
}

struct AroundPlace {
  Int first;  // entry of the coarser table, in its first slice
  Real u, v;  // where between it and the next along both axes; 0 to 1
};

FN Around read_around(AroundPlace place, int slice, int part) {
  Int first = place.first + slice * d.around_rows * d.around_columns;
  Around found;
  for (int c = 0; c < 3; ++c) {
    Int at = first * 6 + (part * 3 + c);
    Real4 a = around_row(at), b = around_row(at + 6);
    Real4 e = around_row(at + d.around_columns * 6), f = around_row(at + (d.around_columns + 1) * 6);
    found.colour[c] = mix_rows(mix_rows(a, b, place.u), mix_rows(e, f, place.u), place.v);
  }
  return found;
}

FN Int around_below(Int ray, int count, INOUT(Real) share) {
  Real at = clamp((to_real(ray) + 0.5f) / float(d.rays_an_entry) - 0.5f, 0.0f, float(count - 1));
  Int low = min(to_int(at), integer(count - 2));
  share = at - to_real(low);
  return low;
}
FN AroundPlace place_around(Int column, Int row) {
  AroundPlace place;
  place.u = real(0.0f), place.v = real(0.0f);
  Int x = around_below(column, d.around_columns, place.u), y = around_below(row, d.around_rows, place.v);
  place.first = y * d.around_columns + x;
  return place;
}

// ---- Light of the lamp.

// That is scattered at p towards the lens, over the lamp's colour; as lamp_glow().
FN Real lamp_glow(Scattering s, Real3 p, Real3 way, Real depth) {
  Real3 from = p - all_lanes(d.lamp_position);
  Real d2 = max(dot(from, from), d.lamp_size2), inverse = inverse_sqrt(d2);
  Real x = (1.0f - dot(from, all_lanes(d.lamp_axis)) * inverse) * d.lamp_cone;
  return exp2(-x * x - depth * 1.44269504f) / d2 * scatter_towards(s, -dot(from, way) * inverse);
}

// Abramowitz and Stegun 4.4.46, within 1e-7.
FN Real arc_cosine(Real x) {
  Real a = min(abs(x), 1.0f);
  Real p = a * -0.0012624911f + 0.0066700901f;
  p = p * a - 0.0170881256f;
  p = p * a + 0.0308918810f;
  p = p * a - 0.0501743046f;
  p = p * a + 0.0889789874f;
  p = p * a - 0.2145988016f;
  p = p * a + 1.5707963050f;
  Real angle = sqrt(1.0f - a) * p;
  return select(x < 0.0f, 3.14159265f - angle, angle);
}

FN Real add_near_terms(Real sum, int four, Int low, Real part, Real3 direction, Real4 left) {
  Real4 row = mix_rows(near_glow_row(low * 4 + four), near_glow_row(low * 4 + (4 + four)), part);
  Real4 terms = harmonics_row(four, direction);
  sum += row.x * terms.x * left.x;
  sum += row.y * terms.y * left.y;
  sum += row.z * terms.z * left.z;
  sum += row.w * terms.w * left.w;
  return sum;
}

// Light that is scattered twice next to the lamp, by what scattering leaves of each order; as NearGlow::at().
FN Real near_glow(Real3 p, Real3 direction, Real4 less) {
  Real3 axis = all_lanes(d.lamp_axis), way = p - all_lanes(d.lamp_position);
  Real r2 = max(dot(way, way), d.lamp_size2), along = dot(way, axis);
  Real missing = inverse_sqrt(r2) - inverse_sqrt(r2 + d.near_glow_cell * d.near_glow_cell);
  Real cosine = clamp(along * inverse_sqrt(r2), -1.0f, 1.0f);
  Real3 aside = way - axis * along;
  Real off = length(aside);
  bool upright = d.lamp_axis[2] * d.lamp_axis[2] >= 0.81f;
  Real3 level = cross(axis, real3(real(upright ? 1.0f : 0.0f), real(0.0f), real(upright ? 0.0f : 1.0f)));
  Real3 x = select(off < 1e-6f, normalize(level), aside * (1.0f / max(off, 1e-6f))), y = cross(axis, x);
  Real3 seen = real3(dot(direction, x), dot(direction, y), dot(direction, axis));
  Real at = arc_cosine(cosine) * (float(d.near_glow_steps) / 3.14159265f);
  Int low = min(to_int(at), integer(d.near_glow_steps - 1));
  Real part = at - to_real(low), sum = real(0.0f);
  sum = add_near_terms(sum, 0, low, part, seen, row_of(less.x, less.y, less.y, less.y));
  sum = add_near_terms(sum, 1, low, part, seen, row_of(less.z, less.z, less.z, less.z));
  sum = add_near_terms(sum, 2, low, part, seen, row_of(less.z, less.w, less.w, less.w));
  sum = add_near_terms(sum, 3, low, part, seen, row_of(less.w, less.w, less.w, less.w));
  return max(sum * missing, 0.0f);
}

// ---- Along a ray.

struct AirRay {
  Real3 eye, way;          // where it starts, and its unit direction
  Real box_near, box_far;  // between which it is in the box; unit: m
  Mask through;            // the box
  AroundPlace around;      // of the looked-up rays about it
};

FN AirRay make_air_ray(Real3 eye, Real3 way, Int column, Int row) {
  AirRay ray;
  ray.eye = eye, ray.way = way;
  ray.box_near = real(0.0f), ray.box_far = real(d.distance[d.slices - 1]);
  ray.through = clip_to_box(eye, way, ray.box_near, ray.box_far);
  ray.around = place_around(column, row);
  return ray;
}

// What has come together on the way so far.
struct AirSum {
  Real3 glow;                // thrown towards the lens; unit: kcd/m2
  Real depth, turned_depth;  // the latter as Air::turned_depth(), but for what is scattered straight on outside the box
};

FN void add_slice(AirRay ray, int slice, Real dust, INOUT(AirSum) sum) {
  float near = d.distance[slice - 1], far = d.distance[slice], at = 0.5f * (near + far);
  Real3 middle = ray.eye + ray.way * real(at);
  Real mist = fog_depth(d.fog_density, d.fog_rate, ray.eye.z + ray.way.z * near, ray.way.z, real(far - near));
  Real drops = real(d.drops[slice]), whole = mist + dust + drops;
  Mask there = whole > 1e-9f;
  if (!any(there)) return;
  Real inverse = 1.0f / max(whole, 1e-12f);
  Scattering s;
  s.fog = mist * inverse, s.dust = dust * inverse, s.drops = drops * inverse;
  Real slice_depth = select(there, (mist + dust) * billows_at(middle) + drops, real(0.0f));
  Real4 less = orders_less(s);
  Real3 source = light_glow(s, middle, ray.way);
  if (d.has_around != 0) {
    source += scattered(read_around(ray.around, slice, 0), orders_of_all(s));
  } else {
    source += even_glow(s, middle);
  }
  sum.glow += source * (exp(-sum.depth) * lost(slice_depth) * d.albedo);
  // The lamp's light goes the same way out and back. Most of what is scattered nearly straight on
  // stays in its beam and in the camera's ray, so both are weakened by what is turned alone; how
  // much is thrown back is by the whole phase function (Nakajima and Tanaka 1988).
  Mask inside = both(ray.through, both(at > ray.box_near, at < ray.box_far));
  Real turned_step = select(inside, slice_depth * turned_share(s), slice_depth);
  Real left = exp(-sum.turned_depth);
  Real share = select(turned_step > 0.0f, left * lost(turned_step) * slice_depth / max(turned_step, 1e-20f) * d.albedo, real(0.0f));
  if (d.lamp != 0) {
    // Next to the lamp its light varies within a slice.
    int parts = near < 0.5f ? 4 : near < 2.0f ? 2 : 1;
    Real once = real(0.0f);
    for (int i = 0; i < parts; ++i) {
      float part = (float(i) + 0.5f) / float(parts);
      once += lamp_glow(s, ray.eye + ray.way * real(near + (far - near) * part), ray.way, sum.turned_depth + part * turned_step);
    }
    Real of_colour = once * share * (1.0f / float(parts));
    if (d.has_near_glow != 0 && near < d.near_glow_reach && any(inside)) {
      Real scattering = d.albedo * less.x * slice_depth * (1.0f / (far - near));
      Real again = near_glow(middle, ray.way, less) * scattering * left * share;
      of_colour += select(inside, again, real(0.0f));
    }
    sum.glow += all_lanes(d.lamp_colour) * of_colour;
  }
  if (d.has_around != 0) sum.glow += scattered(read_around(ray.around, slice, 1), less) * share;
  sum.depth += slice_depth, sum.turned_depth += turned_step;
}
