#include "render/camera/culling.h"

#include <algorithm>
#include <cmath>

namespace rubble {

void DepthPyramid::build(const float* depth, int width, int height) {
  levels_.clear();
  Level base;
  base.width = (width + kTile - 1) / kTile;
  base.height = (height + kTile - 1) / kTile;
  base.farthest.assign(std::size_t(base.width) * std::size_t(base.height), 1e30f);
  for (int y = 0; y < height; ++y) {
    const float* row = depth + std::size_t(y) * std::size_t(width);
    float* out = base.farthest.data() + std::size_t(y / kTile) * std::size_t(base.width);
    for (int tx = 0; tx < base.width; ++tx) {
      const int end = std::min((tx + 1) * kTile, width);
      float low = out[tx];
      for (int x = tx * kTile; x < end; ++x) low = row[x] < low ? row[x] : low;
      out[tx] = low;
    }
  }
  levels_.push_back(std::move(base));
  while (levels_.back().width > 1 || levels_.back().height > 1) {
    const Level& fine = levels_.back();
    Level coarse;
    coarse.width = (fine.width + 1) / 2;
    coarse.height = (fine.height + 1) / 2;
    coarse.farthest.assign(std::size_t(coarse.width) * std::size_t(coarse.height), 1e30f);
    for (int y = 0; y < fine.height; ++y) {
      for (int x = 0; x < fine.width; ++x) {
        float& out = coarse.farthest[std::size_t(y / 2 * coarse.width + x / 2)];
        out = std::min(out, fine.farthest[std::size_t(y * fine.width + x)]);
      }
    }
    levels_.push_back(std::move(coarse));
  }
}

bool DepthPyramid::may_show(int x0, int y0, int x1, int y1, float nearest_value) const {
  x0 = std::max(x0 / kTile, 0), y0 = std::max(y0 / kTile, 0);
  x1 /= kTile, y1 /= kTile;
  std::size_t l = 0;
  while (l + 1 < levels_.size() && (x1 - x0 > 3 || y1 - y0 > 3))
    x0 /= 2, y0 /= 2, x1 /= 2, y1 /= 2, ++l;
  const Level& level = levels_[l];
  x1 = std::min(x1, level.width - 1), y1 = std::min(y1, level.height - 1);
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x)
      if (nearest_value >= level.farthest[std::size_t(y * level.width + x)]) return true;
  return false;
}

ViewVolume::ViewVolume(const ViewProjection& view)
    : fx_(float(view.intrinsics.fx)),
      fy_(float(view.intrinsics.fy)),
      cx_(float(view.intrinsics.cx)),
      cy_(float(view.intrinsics.cy)),
      width_(view.intrinsics.width),
      height_(view.intrinsics.height) {
  // Slopes of the image's edges, half a pixel outside the outermost pixel centres.
  const float left = (-0.5f - cx_) / fx_, right = (float(width_) - 0.5f - cx_) / fx_;
  const float top = (-0.5f - cy_) / fy_, bottom = (float(height_) - 0.5f - cy_) / fy_;
  planes_[0] = normalized(Vec3f(1, 0, -left));
  planes_[1] = normalized(Vec3f(-1, 0, right));
  planes_[2] = normalized(Vec3f(0, 1, -top));
  planes_[3] = normalized(Vec3f(0, -1, bottom));
}

bool ViewVolume::sphere_in_view(const Vec3f& c, float r) const {
  const float reach = r * 1.0001f + 1e-5f;
  if (c.z + reach < kNearPlane) return false;
  for (const Vec3f& plane : planes_)
    if (dot(plane, c) < -reach) return false;
  return true;
}

bool ViewVolume::box_may_show(const Vec3f& c, const Mat3f& half,
                              const DepthPyramid& pyramid) const {
  const auto& [x, y, z] = half.rows;
  const float deep = std::fabs(x.z) + std::fabs(y.z) + std::fabs(z.z) + 1e-5f;
  const float near_z = c.z - deep * 1.0001f;
  if (near_z <= kNearPlane) return true;
  float low_u = 1e30f, high_u = -1e30f, low_v = 1e30f, high_v = -1e30f;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3f p = c + (corner & 1 ? x : -x) + (corner & 2 ? y : -y) + (corner & 4 ? z : -z);
    const float u = p.x / p.z, v = p.y / p.z;
    low_u = std::min(low_u, u), high_u = std::max(high_u, u);
    low_v = std::min(low_v, v), high_v = std::max(high_v, v);
  }
  // Rounding outwards takes in every pixel whose centre the box can cover.
  const float x0 = std::floor(fx_ * low_u + cx_), x1 = std::ceil(fx_ * high_u + cx_);
  const float y0 = std::floor(fy_ * low_v + cy_), y1 = std::ceil(fy_ * high_v + cy_);
  if (x1 < 0 || y1 < 0 || x0 >= float(width_) || y0 >= float(height_)) return false;
  const auto clip = [](float value, int size) {
    return int(std::clamp(value, 0.0f, float(size - 1)));
  };
  return pyramid.may_show(clip(x0, width_), clip(y0, height_), clip(x1, width_), clip(y1, height_),
                          kNearPlane / near_z * 1.00001f);
}

bool faces_away(const Vec3f& eye, const Vec3f& centre, float radius, const Vec3f& cone_axis,
                float cone_cosine) {
  if (cone_cosine <= 0) return false;
  const float sine = std::sqrt(std::max(0.0f, 1 - cone_cosine * cone_cosine));
  const Vec3f to = centre - eye;
  return dot(to, cone_axis) > sine * norm(to) + radius * 1.0001f + 1e-5f;
}

}  // namespace rubble
