// Surfaces with the colours of a user's file, read as in shaders/paint.glsl.
#pragma once

#include "render/shading/texture_reads.h"

namespace rubble::RUBBLE_ISA {

struct Paint {
  Real3 albedo, normal;                    // the latter in the mesh frame
  Real roughness, metalness, reflectance;  // as paint_over() wants them
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
    return decode_srgb3(Real3{byte_of(c, 0) * (1.0f / 255), byte_of(c, 8) * (1.0f / 255),
                              byte_of(c, 16) * (1.0f / 255)});
  };
  Paint p;
  p.albedo = Real3{as_real(p0.x), as_real(p0.y), as_real(p0.z)} *
             (corner(t2.x) * w.x + corner(t2.y) * w.y + corner(t2.z) * w.z);
  p.normal = normal;
  p.roughness = as_real(p0.w), p.metalness = as_real(p1.x), p.reflectance = as_real(p1.y);
  const Real u0 = as_real(t0.x), v0 = as_real(t0.y), u1 = as_real(t0.z), v1 = as_real(t0.w),
             u2 = as_real(t1.x), v2 = as_real(t1.y);
  const Real u = w.x * u0 + w.y * u1 + w.z * u2, v = 1.0f - (w.x * v0 + w.y * v1 + w.z * v2);
  const PaintAxes axes = find_paint_axes(ab, ac, u1 - u0, v1 - v0, u2 - u0, v2 - v0);
  const Real level = paint_level(axes, float(d.paint_side), footprint);
  const Mask image = as_real(p1.z) >= 0.0f, relief = as_real(p1.w) >= 0.0f;
  if (any(image)) {
    const Texel texel = read_image(d.paints, to_int(max(as_real(p1.z), 0.0f)), u, v, level);
    p.albedo = select(image, p.albedo * decode_srgb3(Real3{texel.x, texel.y, texel.z}), p.albedo);
  }
  if (any(relief)) {
    const Texel texel = read_image(d.paints, to_int(max(as_real(p1.w), 0.0f)), u, v, level);
    p.roughness = select(relief, p.roughness * texel.z, p.roughness);
    p.metalness = select(relief, p.metalness * texel.w, p.metalness);
    p.normal = select(relief, bend_paint(axes, normal, texel.x, texel.y), p.normal);
  }
  return p;
}

}  // namespace rubble::RUBBLE_ISA
