#include "render/materials/paint_layers.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/quick_math.h"

namespace rubble {
namespace {

constexpr std::size_t kMostBytes = std::size_t(512) << 20;  // of all images at their finest

// Of another side, a power of two like its own.
PatternImage resize(const PaintImage& image, int side, bool encoded) {
  if (side == image.side) return {side, image.texels};
  const TextureStack stack({{image.side, image.texels}}, {encoded});
  if (side < image.side) return {side, stack.texels(0, int(std::lround(quick::log2(double(image.side / side)))))};
  PatternImage out{side, {}};
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      for (const float value : stack.read(0, (float(x) + 0.5f) / float(side), (float(y) + 0.5f) / float(side), 0))
        out.texels.push_back(std::uint8_t(value * 255 + 0.5f));
  return out;
}

// The texel at a place, as linear light.
Vec3f albedo_at(const PaintImage& image, float u, float v) {
  if (image.side == 0) return {1, 1, 1};
  const auto texel = [&image](float x) {
    return std::min(std::size_t((x - std::floor(x)) * float(image.side)), std::size_t(image.side - 1));
  };
  const std::uint8_t* at = &image.texels[(texel(1 - v) * std::size_t(image.side) + texel(u)) * 4];
  return {decode_srgb(at[0]), decode_srgb(at[1]), decode_srgb(at[2])};
}

Vec3f times(const Vec3f& a, const Vec3f& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

}  // namespace

PaintLayers make_paint_layers(const std::vector<std::shared_ptr<const SurfacePaint>>& paints) {
  PaintLayers out;
  int side = 1;
  std::size_t count = 0;
  for (const auto& paint : paints)
    for (const PaintImage* image : {&paint->albedo, &paint->relief})
      if (image->side > 0) side = std::max(side, image->side), ++count;
  while (side > 1 && count * std::size_t(side) * std::size_t(side) * 4 > kMostBytes) side /= 2;
  std::vector<PatternImage> images;
  std::vector<bool> encoded;
  const auto add = [&](const PaintImage& image, bool is_encoded) {
    if (image.side == 0) return -1;
    images.push_back(resize(image, side, is_encoded));
    encoded.push_back(is_encoded);
    return int(images.size()) - 1;
  };
  for (const auto& paint : paints)
    out.paints.push_back({paint->colour, paint->roughness, paint->metalness, paint->reflectance,
                          add(paint->albedo, true), add(paint->relief, false)});
  out.image_count = int(images.size());
  if (!images.empty()) out.images = TextureStack(images, encoded);
  return out;
}

Vec3f mean_paint(const TriangleMesh& mesh, std::size_t surface) {
  const SurfacePaint& paint = *mesh.paints[surface];
  Vec3 sum;
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.surfaces[t] != surface) continue;
    const auto& corners = mesh.paint_corners[t];
    const Vec3f& p = mesh.positions[mesh.triangles[t][0]];
    const double weight = double(norm(cross(mesh.positions[mesh.triangles[t][1]] - p,
                                            mesh.positions[mesh.triangles[t][2]] - p)));
    // In the middle, and near the corners.
    for (const auto& [a, b] : {std::pair(1 / 3.0f, 1 / 3.0f), {0.8f, 0.1f}, {0.1f, 0.8f}, {0.1f, 0.1f}}) {
      const float c = 1 - a - b;
      const float u = corners[0].u * a + corners[1].u * b + corners[2].u * c;
      const float v = corners[0].v * a + corners[1].v * b + corners[2].v * c;
      const Vec3f colour = corners[0].colour * a + corners[1].colour * b + corners[2].colour * c;
      sum += Vec3(times(times(paint.colour, colour), albedo_at(paint.albedo, u, v))) * weight;
      area += weight;
    }
  }
  return area > 0 ? Vec3f(sum * (1 / area)) : paint.colour;
}

}  // namespace rubble
