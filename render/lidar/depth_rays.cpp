#include "render/lidar/depth_rays.h"

#include <algorithm>
#include <limits>

#include "render/scene/scene.h"

namespace rubble {
namespace {

constexpr int kPixelsAtOnce = 512;  // rays that a thread takes at once
constexpr int kPacketSize = int(LidarWorld::kPacket);

}  // namespace

DepthRays::DepthRays(const Intrinsics& k, double max_range) : k_(k), max_range_(max_range) {
  for (int v = 0; v < k.height; ++v)
    for (int u = 0; u < k.width; ++u) {
      const Vec3 optical((u - k.cx) / k.fx, (v - k.cy) / k.fy, 1);
      cosines_.push_back(1 / norm(optical));
      directions_.push_back(normalized(camera_from_optical * optical));
    }
}

void DepthRays::cast(const LidarWorld& world, const Pose& world_from_camera, ThreadPool& pool, float* depth,
                     std::int32_t* pieces) const {
  const Mat3 turn = world_from_camera.rotation.matrix();
  pool.run(int(directions_.size()), kPixelsAtOnce, [&](int begin, int end) {
    LidarWorld::Ray rays[kPacketSize];
    LidarWorld::Hit hits[kPacketSize];
    for (int first = begin; first < end; first += kPacketSize) {
      const int count = std::min(kPacketSize, end - first);
      for (int i = 0; i < count; ++i)
        rays[i] = {world_from_camera.translation, turn * directions_[std::size_t(first + i)], 0};
      world.cast(rays, std::size_t(count), max_range_, hits);
      for (int i = 0; i < count; ++i) {
        const std::size_t pixel = std::size_t(first + i);
        depth[pixel] = hits[i].distance < 0 ? std::numeric_limits<float>::infinity()
                                            : float(hits[i].distance * cosines_[pixel]);
        if (pieces) pieces[pixel] = hits[i].piece;
      }
    }
  });
}

}  // namespace rubble
