#include "render/transport/paint_point.h"

#include <algorithm>
#include <cmath>

namespace rubble {
namespace {

Vec3f times(const Vec3f& a, const Vec3f& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

float grey_of(const Vec3f& c) { return dot(c, Vec3f(0.2126f, 0.7152f, 0.0722f)); }

// Where a point lies in the images, how coarse they are to be read, and the directions in the surface that are to the
// right and upwards in them.
struct Place {
  float u, v, level;
  Vec3f right, up;  // of any length
};

Place find_place(const PaintLayers& layers, const TrianglePaint& paint, const PaintQuery& query) {
  const auto& c = paint.corners;
  const auto& w = query.weights;
  const Vec3f ab = query.corners[1] - query.corners[0], ac = query.corners[2] - query.corners[0];
  const float u1 = c[1].u - c[0].u, v1 = c[1].v - c[0].v, u2 = c[2].u - c[0].u, v2 = c[2].v - c[0].v;
  const float turn = u1 * v2 - v1 * u2;  // twice the triangle's area in the images
  const float sign = turn < 0 ? -1.0f : 1.0f;
  const float share = std::fabs(turn) / std::max(norm(cross(ab, ac)), 1e-20f);
  const float texels = float(layers.images.size()) * std::sqrt(share) * query.footprint;
  Place out;
  out.u = c[0].u * w[0] + c[1].u * w[1] + c[2].u * w[2];
  out.v = c[0].v * w[0] + c[1].v * w[1] + c[2].v * w[2];
  out.level = texels > 1 ? std::log2(texels) : 0;
  out.right = (ab * v2 - ac * v1) * sign, out.up = (ac * u1 - ab * u2) * sign;
  return out;
}

// x, y: of the normal in the image; range: -1 to 1.
Vec3f bend(const Vec3f& normal, const Place& place, float x, float y) {
  const Vec3f right = place.right - normal * dot(place.right, normal);
  const Vec3f up = place.up - normal * dot(place.up, normal);
  const float a = norm(right), b = norm(up);
  if (a <= 0 || b <= 0) return normal;
  return normalized(right * (x / a) + up * (y / b) + normal * std::sqrt(std::max(1 - x * x - y * y, 0.04f)));
}

}  // namespace

PaintPoint find_paint(const PaintLayers& layers, const TrianglePaint& paint, const PaintQuery& query) {
  const PaintLayers::Paint& p = layers.paints[std::size_t(paint.paint)];
  const auto& c = paint.corners;
  const auto& w = query.weights;
  PaintPoint out;
  out.albedo = times(p.colour, c[0].colour * w[0] + c[1].colour * w[1] + c[2].colour * w[2]);
  out.normal = query.normal;
  out.metalness = p.metalness;
  float roughness = p.roughness;
  const Place place = p.albedo >= 0 || p.relief >= 0 ? find_place(layers, paint, query) : Place();
  if (p.albedo >= 0) {
    const auto texel = layers.images.read(p.albedo, place.u, 1 - place.v, place.level);
    // Decoded after it was found between texels, as the shader does.
    out.albedo = times(out.albedo, {linear_from_srgb_code(texel[0]), linear_from_srgb_code(texel[1]),
                                    linear_from_srgb_code(texel[2])});
  }
  if (p.relief >= 0) {
    const auto texel = layers.images.read(p.relief, place.u, 1 - place.v, place.level);
    roughness *= texel[2], out.metalness *= texel[3];
    out.normal = bend(query.normal, place, (texel[0] * 255 - 128) / 127, (texel[1] * 255 - 128) / 127);
  }
  out.roughness = std::max(roughness * roughness, 0.02f);
  out.reflectance = p.reflectance + (std::min(grey_of(out.albedo), 0.99f) - p.reflectance) * out.metalness;
  return out;
}

}  // namespace rubble
