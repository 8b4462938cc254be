#include "render/transport/drawn_albedo.h"

namespace rubble {

AlbedoAt drawn_albedo(const LookSurfaces& surfaces) {
  return [&surfaces](const RayScene::Triangle& triangle, float u, float v) {
    constexpr float kMeanOver = 0.1f;  // unit: m
    SurfacePoint point;
    surfaces.find({triangle, u, v, {0, 0, -1}, kMeanOver}, point);
    return mean_albedo(point.reflection);
  };
}

}  // namespace rubble
