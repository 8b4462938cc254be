#include "render/rays/depth_rays.h"

#include <algorithm>
#include <limits>

#include "render/scene/scene.h"

namespace rubble {
namespace {

constexpr int kPixelsAtOnce = 512;  // rays that a thread takes at once
constexpr int kPacketSize = int(RayWorld::kPacket);
constexpr int kTileWidth = 4, kTileHeight = 2;  // of a packet, in pixels: its rays meet more of the same than those of a row

std::vector<std::uint32_t> order_by_tiles(int width, int height) {
  std::vector<std::uint32_t> order;
  for (int v0 = 0; v0 < height; v0 += kTileHeight)
    for (int u0 = 0; u0 < width; u0 += kTileWidth)
      for (int v = v0; v < std::min(height, v0 + kTileHeight); ++v)
        for (int u = u0; u < std::min(width, u0 + kTileWidth); ++u) order.push_back(std::uint32_t(v * width + u));
  return order;
}

}  // namespace

DepthRays::DepthRays(const Intrinsics& k, double max_range) : k_(k), max_range_(max_range), order_(order_by_tiles(k.width, k.height)) {
  for (int v = 0; v < k.height; ++v)
    for (int u = 0; u < k.width; ++u) {
      const Vec3 optical((u - k.cx) / k.fx, (v - k.cy) / k.fy, 1);
      cosines_.push_back(1 / norm(optical));
      directions_.push_back(normalized(camera_from_optical * optical));
    }
}

void DepthRays::cast(const RayWorld& world, const Pose& world_from_camera, ThreadPool& pool, float* depth,
                     std::int32_t* pieces) const {
  const Mat3 turn = world_from_camera.rotation.matrix();
  pool.run(int(directions_.size()), kPixelsAtOnce, [&](int begin, int end) {
    RayWorld::Ray rays[kPacketSize];
    double distances[kPacketSize];
    std::int32_t met[kPacketSize];
    for (int first = begin; first < end; first += kPacketSize) {
      const int count = std::min(kPacketSize, end - first);
      const std::uint32_t* const pixels = &order_[std::size_t(first)];
      for (int i = 0; i < count; ++i) rays[i] = {world_from_camera.translation, turn * directions_[pixels[i]], 0};
      world.cast(rays, std::size_t(count), max_range_, distances, pieces ? met : nullptr);
      for (int i = 0; i < count; ++i) {
        const std::size_t pixel = pixels[i];
        depth[pixel] = distances[i] < 0 ? std::numeric_limits<float>::infinity() : float(distances[i] * cosines_[pixel]);
        if (pieces) pieces[pixel] = met[i];
      }
    }
  });
}

}  // namespace rubble
