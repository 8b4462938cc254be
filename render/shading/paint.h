// Surfaces with the colours of a user's file: the formulas of shaders/paint.glsl.
#pragma once

#include "render/shading/texture_reads.h"

namespace rubble::RUBBLE_ISA {

RUBBLE_INLINE Real decode_srgb(Real code) {
  return select(code <= 0.04045f, code * (1.0f / 12.92f),
                pow((code + 0.055f) * (1.0f / 1.055f), 2.4f));
}
RUBBLE_INLINE Real3 decode_srgb(const Real3& c) {
  return {decode_srgb(c.x), decode_srgb(c.y), decode_srgb(c.z)};
}

struct Paint {
  Real3 albedo, normal;                    // the latter in the mesh frame
  Real roughness, metalness, reflectance;  // as of PaintPoint
};

// w: weights of the corners; ab, ac: edges, mesh frame; footprint: width of what is seen across the
// surface there.
inline Paint find_paint(const ShadingData& d, Int triangle, const Real3& w, const Real3& ab,
                        const Real3& ac, const Real3& normal, Real footprint) {
  const Int at = 2 * d.paint_count + 3 * triangle;
  const Row t0 = load_rows(d.paint, at), t1 = load_rows(d.paint, at + 1),
            t2 = load_rows(d.paint, at + 2);
  const Row p0 = load_rows(d.paint, Int(t1.z) * 2), p1 = load_rows(d.paint, Int(t1.z) * 2 + 1);
  const auto corner = [](Word c) {
    return decode_srgb(Real3{byte_of(c, 0) * (1.0f / 255), byte_of(c, 8) * (1.0f / 255),
                             byte_of(c, 16) * (1.0f / 255)});
  };
  Paint p;
  p.albedo = Real3{as_real(p0.x), as_real(p0.y), as_real(p0.z)} *
             (corner(t2.x) * w.x + corner(t2.y) * w.y + corner(t2.z) * w.z);
  p.normal = normal;
  Real rough = as_real(p0.w);
  p.metalness = as_real(p1.x);
  const Real u0 = as_real(t0.x), v0 = as_real(t0.y), u1 = as_real(t0.z), v1 = as_real(t0.w),
             u2 = as_real(t1.x), v2 = as_real(t1.y);
  const Real u = w.x * u0 + w.y * u1 + w.z * u2, v = 1.0f - (w.x * v0 + w.y * v1 + w.z * v2);
  const Real d1x = u1 - u0, d1y = v1 - v0, d2x = u2 - u0, d2y = v2 - v0;
  const Real turn = d1x * d2y - d1y * d2x;
  const Real level = log2(
      max(float(d.paint_side) * sqrt(abs(turn) / max(length(cross(ab, ac)), 1e-20f)) * footprint,
          1.0f));
  const Mask image = as_real(p1.z) >= 0.0f, relief = as_real(p1.w) >= 0.0f;
  if (any(image)) {
    const Texel texel = read_image(d.paints, to_int(max(as_real(p1.z), 0.0f)), u, v, level);
    p.albedo = select(image, p.albedo * decode_srgb(Real3{texel.x, texel.y, texel.z}), p.albedo);
  }
  if (any(relief)) {
    const Texel texel = read_image(d.paints, to_int(max(as_real(p1.w), 0.0f)), u, v, level);
    rough = select(relief, rough * texel.z, rough);
    p.metalness = select(relief, p.metalness * texel.w, p.metalness);
    const Real sign = select(turn < 0.0f, real(-1), real(1));
    const Real sx = (texel.x * 255.0f - 128.0f) * (1.0f / 127) * sign,
               sy = (texel.y * 255.0f - 128.0f) * (1.0f / 127) * sign;
    Real3 along = ab * d2y - ac * d1y, across = ac * d1x - ab * d2x;
    along = along - normal * dot(along, normal), across = across - normal * dot(across, normal);
    const Real3 bent = along * (sx * inverse_sqrt(max(dot(along, along), 1e-30f))) +
                       across * (sy * inverse_sqrt(max(dot(across, across), 1e-30f)));
    p.normal = select(relief, normalize(bent + normal * sqrt(max(1.0f - sx * sx - sy * sy, 0.04f))),
                      p.normal);
  }
  p.roughness = max(rough * rough, 0.02f);
  p.reflectance = mix(as_real(p1.y), min(grey_of(p.albedo), 0.99f), p.metalness);
  return p;
}

}  // namespace rubble::RUBBLE_ISA
