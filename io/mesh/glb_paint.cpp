#include "io/mesh/mesh_writers.h"

#include <algorithm>
#include <cmath>

#include "io/image/image_file.h"

namespace rubble {
namespace {

constexpr int kCompression = 6;

template <typename Pixel>
std::string encode(const PaintImage& image, const Pixel& pixel) {
  RgbImage out{image.side, image.side, {}};
  out.rgb.reserve(image.texels.size() / 4 * 3);
  for (std::size_t i = 0; i < image.texels.size(); i += 4)
    for (const std::uint8_t value : pixel(&image.texels[i])) out.rgb.push_back(value);
  return encode_png(out, kCompression);
}

std::uint8_t height_of(std::uint8_t x, std::uint8_t y) {
  const double a = (x - 128) / 127.0, b = (y - 128) / 127.0;
  return std::uint8_t(128 + 127 * std::sqrt(std::max(1 - a * a - b * b, 0.0)) + 0.5);
}

// To the right and upwards in the images, across a triangle; of any length.
struct Directions {
  Vec3f right, up;
};
Directions directions_of(const TriangleMesh& mesh, std::size_t t) {
  const auto& corners = mesh.paint_corners[t];
  const Vec3f& a = mesh.positions[mesh.triangles[t][0]];
  const Vec3f ab = mesh.positions[mesh.triangles[t][1]] - a, ac = mesh.positions[mesh.triangles[t][2]] - a;
  const float u1 = corners[1].u - corners[0].u, v1 = corners[1].v - corners[0].v;
  const float u2 = corners[2].u - corners[0].u, v2 = corners[2].v - corners[0].v;
  const float sign = u1 * v2 - v1 * u2 < 0 ? -1.0f : 1.0f;
  return {(ab * v2 - ac * v1) * sign, (ac * u1 - ab * u2) * sign};
}

// Any unit vector across a normal.
Vec3f across(const Vec3f& normal) {
  return normalized(cross(normal, std::fabs(normal.z) < 0.9f ? Vec3f(0, 0, 1) : Vec3f(1, 0, 0)));
}

}  // namespace

GlbImages make_glb_images(const SurfacePaint& paint) {
  using Rgb = std::array<std::uint8_t, 3>;
  GlbImages out;
  if (paint.albedo.side > 0)
    out.base_colour = encode(paint.albedo, [](const std::uint8_t* t) { return Rgb{t[0], t[1], t[2]}; });
  if (paint.relief.side == 0) return out;
  bool bent = false, varied = false;
  for (std::size_t i = 0; i < paint.relief.texels.size(); i += 4) {
    const std::uint8_t* t = &paint.relief.texels[i];
    bent = bent || t[0] != 128 || t[1] != 128;
    varied = varied || t[2] != 255 || t[3] != 255;
  }
  if (bent)
    out.normal = encode(paint.relief, [](const std::uint8_t* t) { return Rgb{t[0], t[1], height_of(t[0], t[1])}; });
  if (varied)
    out.metallic_roughness = encode(paint.relief, [](const std::uint8_t* t) { return Rgb{0, t[2], t[3]}; });
  return out;
}

GlbCorners make_glb_corners(const TriangleMesh& mesh, std::size_t surface) {
  GlbCorners out;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.surfaces[t] != surface) continue;
    const Directions images = directions_of(mesh, t);
    const Vec3f& a = mesh.positions[mesh.triangles[t][0]];
    const Vec3f ab = mesh.positions[mesh.triangles[t][1]] - a, ac = mesh.positions[mesh.triangles[t][2]] - a;
    const Vec3f face = normalized(cross(ab, ac));
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh.triangles[t][k];
      const PaintCorner& corner = mesh.paint_corners[t][k];
      out.positions.push_back(mesh.positions[v]);
      const Vec3f normal = mesh.normals.empty() ? face : mesh.normals[v];
      const Vec3f right = images.right - normal * dot(images.right, normal);
      const Vec3f tangent = norm(right) > 0 ? normalized(right) : across(normal);
      out.normals.push_back(normal);
      out.tangents.push_back(tangent);
      out.handedness.push_back(dot(cross(normal, tangent), images.up) < 0 ? -1.0f : 1.0f);
      out.colours.push_back(corner.colour);
      out.places.insert(out.places.end(), {corner.u, 1 - corner.v});
      out.coloured = out.coloured || corner.colour.x != 1 || corner.colour.y != 1 || corner.colour.z != 1;
    }
  }
  return out;
}

}  // namespace rubble
