#include "render/transport/paint_point.h"

#include "render/surface/scalar_surface.h"

namespace rubble {
namespace {

Vec3f times(const Vec3f& a, const Vec3f& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

}  // namespace

PaintPoint find_paint(const PaintLayers& layers, const TrianglePaint& paint, const PaintQuery& query) {
  const PaintLayers::Paint& p = layers.paints[std::size_t(paint.paint)];
  const auto& c = paint.corners;
  const auto& w = query.weights;
  PaintPoint out;
  out.albedo = times(p.colour, c[0].colour * w[0] + c[1].colour * w[1] + c[2].colour * w[2]);
  out.normal = query.normal;
  out.roughness = p.roughness, out.metalness = p.metalness, out.reflectance = p.reflectance;
  if (p.albedo < 0 && p.relief < 0) return out;
  const auto edge = [&](std::size_t i) { return scalar::real3(query.corners[i] - query.corners[0]); };
  const scalar::PaintAxes axes = scalar::find_paint_axes(edge(1), edge(2), c[1].u - c[0].u, c[1].v - c[0].v,
                                                         c[2].u - c[0].u, c[2].v - c[0].v);
  const float level = scalar::paint_level(axes, float(layers.images.size()), query.footprint);
  const float u = c[0].u * w[0] + c[1].u * w[1] + c[2].u * w[2], v = c[0].v * w[0] + c[1].v * w[1] + c[2].v * w[2];
  if (p.albedo >= 0) {
    const auto texel = layers.images.read(p.albedo, u, 1 - v, level);
    // Decoded after it was found between texels.
    out.albedo = times(out.albedo, scalar::to_vec3(scalar::decode_srgb3({texel[0], texel[1], texel[2]})));
  }
  if (p.relief >= 0) {
    const auto texel = layers.images.read(p.relief, u, 1 - v, level);
    out.roughness *= texel[2], out.metalness *= texel[3];
    out.normal = scalar::to_vec3(scalar::bend_paint(axes, scalar::real3(query.normal), texel[0], texel[1]));
  }
  return out;
}

}  // namespace rubble
