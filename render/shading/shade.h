// From "which triangle is here" to colour: surface, light, air, tone. The formulas of shaders/resolve.frag.glsl, by the same
// names. Those of the surface are in shaders/surface_model.glsl, those of tone in shaders/tone.glsl.
#pragma once

#include "render/shading/contact.h"
#include "render/shading/find_surface.h"
#include "render/shading/lights.h"
#include "render/shading/soft_sun.h"

namespace rubble::RUBBLE_ISA {

// A pixel's ray and what it meets.
struct Pixel {
  Int x, y, index;       // of the image; the last counts rows
  Real3 eye, direction;  // unit length
  Real3 slope;           // of the ray, in the optical frame
  Real3 across, down;    // how the ray changes from pixel to pixel, at unit depth, in the world
  Real size_across, size_down;  // what the two before are times; unit: 1
  Real length;                  // of the ray at unit depth
  Real z;                       // depth along the optical axis; unit: m
  Word placed, triangle;        // the first is 0: nothing
};

struct Shading {
  Real3 e, glare;  // on the albedo, and mirrored
};

RUBBLE_INLINE Real mirrored_share(const ShadingData& d, const Surface& s, Real cosine) {
  const Real gloss = gloss_share(s.layers, cosine);
  return d.wet ? gloss + film_share(s.layers, cosine) : gloss;
}

RUBBLE_INLINE void reflect(const ShadingData& d, const Pixel& pixel, const Surface& s, const Real3& to_light,
                           const Real3& e, Shading& sum) {
  const MirrorAngles angles = find_mirror_angles(s.normal, to_light, -pixel.direction);
  Real lobe = gloss_lobe(s.layers, angles);
  if (d.wet) lobe += film_lobe(s.layers, angles);
  sum.glare += e * lobe;
  sum.e += e * base_share(s.layers, mirrored_share(d, s, dot(s.normal, to_light)));
}

// Soft shadows of the sun at pixels whose block meets an edge.
RUBBLE_INLINE void soften(const ShadingData& d, const Pixel& pixel, const Surface& s,
                          const Real3& world, Real& seen) {
  const Real edge =
      gather(d.sun_edges.blocks, (pixel.y >> 2) * d.sun_edges.blocks_across + (pixel.x >> 2));
  const Mask wanted = Mask(edge < 2.0f) & Mask(pixel.placed != 0u);
  if (!any(wanted)) return;
  const Sight sight{pixel.direction, pixel.across, pixel.down, pixel.size_across * pixel.z,
                    pixel.size_down * pixel.z};
  const SunShare share = sun_share(d, wanted, edge, world, s.face_normal, sight);
  seen = select(share.partly, share.share, seen);
}

RUBBLE_INLINE void add_light(const ShadingData& d, int i, const Pixel& pixel, const Surface& s,
                             const Real3& world, Shading& sum) {
  const Arriving light = light_at(d, i, world);
  // A bumped normal must not catch light that the face itself cannot see.
  const Real facing = max(dot(s.normal, light.to_light), 0.0f) *
                      clamp(dot(s.face_normal, light.to_light) * 8.0f, 0.0f, 1.0f);
  const Mask lit = Mask(facing * light.illuminance.y > 0.0f) & Mask(pixel.placed != 0u);
  if (!any(lit)) return;
  Real seen = light_visible(d, i, world, s.face_normal);
  if (i == 0 && d.sun_edges.blocks) soften(d, pixel, s, world, seen);
  if (!any(lit & Mask(seen > 0.0f))) return;
  Real3 e = light.illuminance * (facing * seen);
  if (d.air) e *= air_passes(d, i, world, light.to_light);
  reflect(d, pixel, s, light.to_light, e, sum);
}

RUBBLE_INLINE void add_lamp(const ShadingData& d, const Pixel& pixel, const Surface& s,
                            const Real3& world, Real in_sight, Real passed, Shading& sum) {
  const Arriving lamp = lamp_at(d, world);
  Real share = max(dot(s.normal, lamp.to_light), 0.0f) *
               clamp(dot(s.face_normal, lamp.to_light) * 8.0f, 0.0f, 1.0f) * in_sight;
  if (d.air) share *= pow(passed, d.frame.air_drops[1]);
  const Real3 e = lamp.illuminance * share;
  reflect(d, pixel, s, lamp.to_light, e, sum);
}

// clear: share of light that goes straight through.
inline Real3 shade_surface(const ShadingData& d, const Pixel& pixel, const Real3& world,
                           Real passed, Real3& clear) {
  // Lanes that see nothing take a triangle of the first mesh, and nobody reads what they find.
  const Mask nothing = Mask(pixel.placed == 0u);
  const Word placed = Word(select(nothing, integer(0), Int(pixel.placed) - 1));
  const Word triangle = Word(select(nothing, integer(int(d.any_triangle)), Int(pixel.triangle)));
  const Surface s = find_surface(d, placed, triangle, world, pixel.direction, pixel.z);
  clear = s.layers.clear;
  Shading sum{s.ambient, {real(0), real(0), real(0)}};
  for (int i = 0; i < d.light_count; ++i) add_light(d, i, pixel, s, world, sum);
  if (d.lamp) {
    const OpennessGrid& o = d.openness;
    const Between x = between_clamped((to_real(pixel.x) + 0.5f) * (1.0f / float(d.width)), o.width);
    const Between y = between_clamped((to_real(pixel.y) + 0.5f) * (1.0f / float(d.height)), o.height);
    add_lamp(d, pixel, s, world, read_half(o.lamp, o.stride, x, y), passed, sum);
  }
  // What the mirrors on top throw back of the light all around, the base below does not get.
  const Real mirrored = mirrored_share(d, s, -dot(s.normal, pixel.direction));
  Real3 around = s.ambient;
  if (d.surrounded) {
    // Panes and puddles show the sky above the roofs.
    const Real3 to_sky = pixel.direction - s.normal * (2.0f * dot(s.normal, pixel.direction));
    Real even = s.layers.cover * (1.0f - smoothstep(0.04f, 0.12f, s.layers.roughness));
    if (d.wet) even = max(even, s.layers.film);
    even *= smoothstep(0.05f, 0.4f, to_sky.z);
    if (any(even > 0.0f))
      around =
          mix(around, sky_radiance(d, {to_sky.x, to_sky.y, max(to_sky.z, 0.01f)}) * real(3.14159f),
              even);
  }
  Real3 out =
      (sum.e * s.layers.albedo * (1.0f - mirrored) + around * mirrored + sum.glare) * real(0.318310f);
  if (d.glow) out += s.layers.glow;
  return out;
}

// Clean air veils what is far: the horizon has no edge.
RUBBLE_INLINE Real3 veil(const ShadingData& d, const Pixel& pixel, Real far,
                         const Real3& radiance) {
  const Real there = max(far - d.veil_from, 0.0f);
  if (!any(Mask(there > 0.0f) & Mask(pixel.placed != 0u))) return radiance;
  // What is far in a street is there, at a visibility of 10 km.
  const Real share = d.surrounded ? exp2(there * -5.64e-4f)
                                  : exp2(there * there * -4e-5f / (1.0f + there * 0.012f));
  return mix(sky_radiance(d, {pixel.direction.x, pixel.direction.y, real(0.02f)}), radiance, share);
}

RUBBLE_INLINE Pixel find_pixel(const ShadingData& d, Int column, Int row) {
  Pixel p;
  p.x = column, p.y = row, p.index = row * d.width + column;
  p.placed = gather(d.ids, p.index * 2), p.triangle = gather(d.ids, p.index * 2 + 1);
  p.z = d.frame.view[0] / max(gather(d.depth_values, p.index), 1e-9f);
  const auto colour = [](const Row& r) { return Real3{as_real(r.x), as_real(r.y), as_real(r.z)}; };
  Real3 rows[3];
  if (d.lens_rays) {
    // Any lens, and for each row the pose at its own time; see passes/ray_pass.h.
    p.slope = colour(load_rows(d.lens_rays, p.index));
    const auto pose = [&](int i, Real& eye) {
      const Row r = load_rows(d.row_poses, row * 3 + i);
      eye = as_real(r.w);
      return colour(r);
    };
    rows[0] = pose(0, p.eye.x), rows[1] = pose(1, p.eye.y), rows[2] = pose(2, p.eye.z);
  } else {
    const auto& lens = d.frame.lens;
    p.slope = {(to_real(column) - lens[2]) * lens[0], (to_real(row) - lens[3]) * lens[1], real(1)};
    for (int i = 0; i < 3; ++i) rows[i] = all_lanes(d.frame.world_from_optical[i]);
    p.eye = {real(d.frame.world_from_optical[0][3]), real(d.frame.world_from_optical[1][3]),
             real(d.frame.world_from_optical[2][3])};
  }
  const auto to_world = [&](const Real3& v) {
    return Real3{dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)};
  };
  p.length = length(p.slope);
  p.direction = to_world(p.slope) * (1.0f / p.length);
  if (!d.lens_rays) {
    p.across = {rows[0].x, rows[1].x, rows[2].x}, p.down = {rows[0].y, rows[1].y, rows[2].y};
    p.size_across = real(d.frame.lens[0]), p.size_down = real(d.frame.lens[1]);
  } else if (d.sun_edges.blocks) {
    // To the next ray, or from the one before at the border of the image; none beyond that of the
    // lens.
    const auto beside = [&](Mask forward, Int next, Int before) {
      const Real3 other = colour(load_rows(d.lens_rays, select(forward, next, before)));
      const Mask none = Mask(other.x == 0.0f) & Mask(other.y == 0.0f) & Mask(other.z == 0.0f);
      const Real sign = select(forward, real(1), real(-1));
      return to_world(select(none, other, (other - p.slope) * sign));
    };
    p.across = beside(column < d.width - 1, p.index + 1, p.index - 1);
    p.down = beside(row < d.height - 1, p.index + d.width, p.index - d.width);
    p.size_across = p.size_down = real(1);
  }
  return p;
}

// What is behind glass, with all air up to there, in place of what is behind no more than the air before the glass.
// radiance: of the glass, with the air before it; air: that.
RUBBLE_INLINE Real3 add_behind(const ShadingData& d, const Pixel& p, Real far, const Texel& air,
                               const Real3& clear, const Real3& radiance) {
  const Mask glass = Mask(clear.y > 0.0f) & Mask(p.placed != 0u);
  if (!any(glass)) return radiance;
  const Row row = load_rows(d.behind, p.index);
  Real3 before = veil(d, p, far, {real(0), real(0), real(0)});
  if (d.air) before = before * air.w + Real3{air.x, air.y, air.z};
  const Real3 behind = Real3{as_real(row.x), as_real(row.y), as_real(row.z)} - before;
  return select(glass, radiance + behind * clear * as_real(row.w), radiance);
}

// Radiance before exposure; kcd/m2.
inline Real3 find_radiance(const ShadingData& d, const Pixel& p) {
  const Mask surface = p.placed != 0u;
  const Real far = select(surface, p.z * p.length, real(1e9f));
  Texel air{real(0), real(0), real(0), real(1)};
  if (d.air)
    air = read_air(
        d, (to_real(p.x) + 0.5f) * (1.0f / float(d.width)),
        (to_real(p.y) + 0.5f) * (1.0f / float(d.height)),
        (far / (far + 2.0f) * float(d.air_slices - 1) + 0.5f) * (1.0f / float(d.air_slices)));
  Real3 radiance{real(0), real(0), real(0)}, clear = radiance;
  if (any(~surface)) radiance = backdrop(d, p.direction);
  if (any(surface)) {
    const Real3 world = p.eye + p.direction * select(surface, far, real(1));
    const Real3 shaded = veil(d, p, far, shade_surface(d, p, world, air.w, clear));
    radiance = select(surface, shaded, radiance);
  }
  if (d.air) radiance = radiance * air.w + Real3{air.x, air.y, air.z};
  return d.behind ? add_behind(d, p, far, air, clear, radiance) : radiance;
}

RUBBLE_INLINE Word display_code(const ShadingData& d, const Pixel& p, const Real3& radiance) {
  const FrameBlock& f = d.frame;
  const Real noise = grain(to_real(p.x) + f.wetness[1], to_real(p.y) + f.wetness[2]);
  const auto code = [&](Real x, float gain, int shift) {
    const Real shown = clamp(develop(x * (f.view[1] * gain), noise), 0.0f, 1.0f);
    return Word(to_int(shown * 255.0f + 0.5f)) << shift;
  };
  return code(radiance.x, f.balance[0], 0) | code(radiance.y, f.balance[1], 8) |
         code(radiance.z, f.balance[2], 16) | 0xff000000u;
}

struct BlockPlace {
  int x, y, columns,
      rows;  // of a block of the grid; the last two: how many of its lanes are within
};

template <typename Value>
RUBBLE_INLINE void store_block(const Value& value, const BlockPlace& b, int width, void* out) {
  static_assert(sizeof(Value) == kWidth * 4);
  for (int i = 0; i < b.rows; ++i)
    std::memcpy(static_cast<char*>(out) + (std::ptrdiff_t(b.y + i) * width + b.x) * 4,
                reinterpret_cast<const char*>(&value) + i * 16, std::size_t(b.columns) * 4);
}

inline void store_linear(const Real3& radiance, Real light, const BlockPlace& b, int width, float* out) {
  for (int i = 0; i < b.rows; ++i) {
    for (int k = 0; k < b.columns; ++k) {
      float* at = out + (std::ptrdiff_t(b.y + i) * width + b.x + k) * 4;
      const int lane = i * 4 + k;
      at[0] = radiance.x[lane], at[1] = radiance.y[lane], at[2] = radiance.z[lane], at[3] = light[lane];
    }
  }
}

inline void shade_block(const ShadingData& d, const ShadedPixels& out, int x, int y) {
  const BlockPlace b{x, y, out.width - x < 4 ? out.width - x : 4,
                     out.height - y < kLaneRows ? out.height - y : kLaneRows};
  const auto to_image = [&](Int at, int size) {
    return min(at * d.every + d.every / 2, integer(size - 1));
  };
  const Pixel p = find_pixel(d, to_image(min(lane_columns() + x, integer(out.width - 1)), d.width),
                             to_image(min(lane_rows() + y, integer(out.height - 1)), d.height));
  Real3 radiance = find_radiance(d, p);
  const Mask beyond = d.lens_rays ? Mask(p.length <= 0.0f) : mask(false);  // outside of the lens
  radiance = select(beyond, {real(0), real(0), real(0)}, radiance);
  if (out.display) store_block(display_code(d, p, radiance), b, out.width, out.display);
  if (out.linear) {
    const Mask dark = gather(d.depth_values, p.index) < 0.0f;
    store_linear(radiance, select(dark, real(0), real(1)), b, out.width, out.linear);
  }
  if (out.stops) {
    const auto& gains = d.frame.balance;
    const Real luminance =
        grey_of({radiance.x * gains[0], radiance.y * gains[1], radiance.z * gains[2]});
    store_block(select(beyond, real(-2000), log2(max(luminance, 1e-30f))), b, out.width, out.stops);
  }
}

inline void shade(const ShadingData& d, const ShadedPixels& out, int first, int last) {
  const int across = (out.width + 3) / 4;
  for (int y = first * 4; y < last * 4 && y < out.height; y += kLaneRows)
    for (int x = 0; x < out.width; x += 4)
      if (!out.blocks || out.blocks[(y >> 2) * across + (x >> 2)]) shade_block(d, out, x, y);
}

}  // namespace rubble::RUBBLE_ISA
