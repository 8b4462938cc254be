// Values between the texels of images, as GL_LINEAR finds them.
#pragma once

#include "render/shading/shading_data.h"
#include "render/shading/wide_math.h"

namespace rubble::RUBBLE_ISA {

struct Texel {
  Real x, y, z, w;  // red, green, blue, alpha; 0 to 1
};

RUBBLE_INLINE Texel mix(const Texel& a, const Texel& b, Real t) {
  return {mix(a.x, b.x, t), mix(a.y, b.y, t), mix(a.z, b.z, t), mix(a.w, b.w, t)};
}

RUBBLE_INLINE Real byte_of(Word w, int shift) { return to_real(Int((w >> shift) & 255u)); }

// Two texels along an axis, and where between them.
struct Between {
  Int first, second;  // their numbers
  Real share;         // of the second
};

// at: 0 to 1 over all texels; beyond the border is the border.
RUBBLE_INLINE Between between_clamped(Real at, int count) {
  const Real x = clamp(at, 0.0f, 1.0f) * float(count) - 0.5f, first = floor(x);
  const Int i = to_int(first);
  return {clamp(i, 0, count - 1), clamp(i + 1, 0, count - 1), x - first};
}

// One level of an image that repeats every 1.
RUBBLE_INLINE Texel read_level(const MipImages& images, Int image, Real u, Real v, Int level) {
  const Int size = images.size >> level, last = size - 1;
  const Real side = to_real(size);
  const Real x = (u - floor(u)) * side - 0.5f, y = (v - floor(v)) * side - 0.5f;
  const Real fx = floor(x), fy = floor(y), a = x - fx, b = y - fy;
  const Int x0 = to_int(fx) & last, x1 = (x0 + 1) & last;
  const Int y0 = to_int(fy) & last, y1 = (y0 + 1) & last;
  const Int first = image * images.stride +
                    Int(gather(reinterpret_cast<const std::uint32_t*>(images.first_texel), level));
  const Int upper = first + y0 * size, lower = first + y1 * size;
  const Word t00 = gather(images.texels, upper + x0), t10 = gather(images.texels, upper + x1);
  const Word t01 = gather(images.texels, lower + x0), t11 = gather(images.texels, lower + x1);
  const Real b1 = b * (1.0f / 255), b0 = (1.0f - b) * (1.0f / 255);
  const Real w00 = (1.0f - a) * b0, w10 = a * b0, w01 = (1.0f - a) * b1, w11 = a * b1;
  const auto channel = [&](int shift) {
    return byte_of(t00, shift) * w00 + byte_of(t10, shift) * w10 + byte_of(t01, shift) * w01 +
           byte_of(t11, shift) * w11;
  };
  return {channel(0), channel(8), channel(16), channel(24)};
}

// level: 0 or above.
RUBBLE_INLINE Texel read_image(const MipImages& images, Int image, Real u, Real v, Real level) {
  level = clamp(level, 0.0f, float(images.levels - 1));
  const Real whole = floor(level), share = level - whole;
  const Int fine = to_int(whole);
  const Texel near = read_level(images, image, u, v, fine);
  if (!any(share > 0.0f)) return near;
  return mix(near, read_level(images, image, u, v, min(fine + 1, integer(images.levels - 1))),
             share);
}

// Of the map of the ground: debris, and tone.
RUBBLE_INLINE Real2 read_ground(const ShadingData& d, Real u, Real v) {
  const Between x = between_clamped(u, d.ground_side), y = between_clamped(v, d.ground_side);
  // Two bytes a texel: a word holds two texels, the pair of one is in its lower or upper half.
  const auto* words = reinterpret_cast<const std::uint32_t*>(d.ground_map);
  const auto texel = [&](Int column, Int row) {
    const Int at = row * d.ground_side + column;
    return gather(words, at >> 1) >> Word((at & 1) << 4);
  };
  const Word t00 = texel(x.first, y.first), t10 = texel(x.second, y.first);
  const Word t01 = texel(x.first, y.second), t11 = texel(x.second, y.second);
  const Real b1 = y.share * (1.0f / 255), b0 = (1.0f - y.share) * (1.0f / 255), a = x.share;
  const auto channel = [&](int shift) {
    return (byte_of(t00, shift) * (1.0f - a) + byte_of(t10, shift) * a) * b0 +
           (byte_of(t01, shift) * (1.0f - a) + byte_of(t11, shift) * a) * b1;
  };
  return {channel(0), channel(8)};
}

RUBBLE_INLINE Real3 read_sky(const ShadingData& d, Real u, Real v) {
  const Between x = between_clamped(u, d.sky_side), y = between_clamped(v, d.sky_side);
  const auto texel = [&](Int column, Int row) {
    const Int at = (row * d.sky_side + column) * 3;
    return Real3{gather(d.sky_map, at), gather(d.sky_map, at + 1), gather(d.sky_map, at + 2)};
  };
  return mix(mix(texel(x.first, y.first), texel(x.second, y.first), x.share),
             mix(texel(x.first, y.second), texel(x.second, y.second), x.share), y.share);
}

// Light thrown back and transmittance.
RUBBLE_INLINE Texel read_air(const ShadingData& d, Real u, Real v, Real slice) {
  const Between x = between_clamped(u, d.air_columns), y = between_clamped(v, d.air_rows);
  const Between z = between_clamped(slice, d.air_slices);
  const auto entry = [&](Int column, Int row, Int layer) {
    const Row r = load_rows(d.air_table, (layer * d.air_rows + row) * d.air_columns + column);
    return Texel{as_real(r.x), as_real(r.y), as_real(r.z), as_real(r.w)};
  };
  const auto along = [&](Int row, Int layer) {
    return mix(entry(x.first, row, layer), entry(x.second, row, layer), x.share);
  };
  const auto plane = [&](Int layer) {
    return mix(along(y.first, layer), along(y.second, layer), y.share);
  };
  return mix(plane(z.first), plane(z.second), z.share);
}

// Of a grid of half the image's size.
RUBBLE_INLINE Real read_half(const float* grid, int width, const Between& x, const Between& y) {
  const Int upper = y.first * width, lower = y.second * width;
  return mix(mix(gather(grid, upper + x.first), gather(grid, upper + x.second), x.share),
             mix(gather(grid, lower + x.first), gather(grid, lower + x.second), x.share), y.share);
}

// Share of the four texels about a place that are not nearer to the light than `depth`.
RUBBLE_INLINE Real compare_shadow(const ShadingData& d, Real u, Real v, Int layer, Real depth) {
  const Between x = between_clamped(u, d.shadow_side), y = between_clamped(v, d.shadow_side);
  const Int first = layer * (d.shadow_side * d.shadow_side);
  const Int upper = first + y.first * d.shadow_side, lower = first + y.second * d.shadow_side;
  const auto lit = [&](Int at) {
    return select(depth <= gather(d.shadow_map, at), real(1), real(0));
  };
  return mix(mix(lit(upper + x.first), lit(upper + x.second), x.share),
             mix(lit(lower + x.first), lit(lower + x.second), x.share), y.share);
}

}  // namespace rubble::RUBBLE_ISA
