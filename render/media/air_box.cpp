#include "render/media/air_box.h"

#include <algorithm>
#include <cmath>

namespace rubble {

Aabb air_box(const Aabb& bounds) {
  constexpr double kMargin = 1.5;  // as of the baked air, lighting/bake_air.cpp; unit: m
  Aabb box = bounds;
  if (box.empty()) box.include({0, 0, 1});
  box.min = box.min - Vec3(kMargin, kMargin, kMargin), box.max = box.max + Vec3(1, 1, 1) * kMargin;
  return box;
}

bool in_box(const Aabb& box, const Vec3& p) {
  return p.x >= box.min.x && p.y >= box.min.y && p.z >= box.min.z && p.x <= box.max.x && p.y <= box.max.y && p.z <= box.max.z;
}

bool clip_to_box(const Aabb& box, const Vec3f& from, const Vec3f& direction, float& near, float& far) {
  for (int axis = 0; axis < 3; ++axis) {
    const float low = float(box.min[axis]), high = float(box.max[axis]), d = direction[axis];
    if (std::fabs(d) < 1e-9f) {
      if (from[axis] < low || from[axis] > high) return false;
      continue;
    }
    const float a = (low - from[axis]) / d, b = (high - from[axis]) / d;
    near = std::max(near, std::min(a, b)), far = std::min(far, std::max(a, b));
  }
  return near < far;
}

}  // namespace rubble
