#include "render/camera/lens.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/portable_math.h"
#include "kernel/base/quick_math.h"

namespace rubble {

namespace {

constexpr double kWidestSlope = 100;  // of a plumb_bob ray: 89.4 degrees from the axis
constexpr int kFoldSteps = 4096;

}  // namespace

Lens::Lens(const Intrinsics& intrinsics) : k_(intrinsics) {
  const auto& d = k_.distortion;
  pinhole_ = k_.lens == LensModel::plumb_bob &&
             std::all_of(d.begin(), d.end(), [](double c) { return c == 0; });
  fold_ = find_fold();
}

double Lens::radial(double r) const {
  const auto& d = k_.distortion;
  const double r2 = r * r;
  if (k_.lens == LensModel::plumb_bob) return r * (1 + r2 * (d[0] + r2 * (d[1] + r2 * d[4])));
  return r * (1 + r2 * (d[0] + r2 * (d[1] + r2 * (d[2] + r2 * d[3]))));
}

double Lens::radial_slope(double r) const {
  const auto& d = k_.distortion;
  const double r2 = r * r;
  if (k_.lens == LensModel::plumb_bob)
    return 1 + r2 * (3 * d[0] + r2 * (5 * d[1] + r2 * 7 * d[4]));
  return 1 + r2 * (3 * d[0] + r2 * (5 * d[1] + r2 * (7 * d[2] + r2 * 9 * d[3])));
}

// Steps that grow with r find the first root for any lens that can be built; bisection refines it.
double Lens::find_fold() const {
  const double widest = k_.lens == LensModel::fisheye ? portable::kPi : kWidestSlope;
  double before = 0;
  for (int i = 1; i <= kFoldSteps; ++i) {
    const double share = double(i) / kFoldSteps, r = widest * share * share;
    if (radial_slope(r) > 0) {
      before = r;
      continue;
    }
    double low = before, high = r;
    for (int b = 0; b < 60; ++b) {
      const double middle = 0.5 * (low + high);
      (radial_slope(middle) > 0 ? low : high) = middle;
    }
    return low;
  }
  return widest;
}

PixelPoint Lens::distort(double x, double y) const {
  const auto& d = k_.distortion;
  const double r2 = x * x + y * y;
  const double grown = 1 + r2 * (d[0] + r2 * (d[1] + r2 * d[4]));
  return {x * grown + 2 * d[2] * x * y + d[3] * (r2 + 2 * x * x),
          y * grown + d[2] * (r2 + 2 * y * y) + 2 * d[3] * x * y};
}

std::optional<PixelPoint> Lens::project(const Vec3& p) const {
  PixelPoint at;
  if (k_.lens == LensModel::fisheye) {
    const double side = std::sqrt(p.x * p.x + p.y * p.y);
    const double theta = quick::atan2(side, p.z);
    if (theta > fold_ || (side == 0 && p.z <= 0)) return std::nullopt;
    const double scale = side > 0 ? radial(theta) / side : 0;
    at = {p.x * scale, p.y * scale};
  } else {
    if (p.z <= 0) return std::nullopt;
    const double x = p.x / p.z, y = p.y / p.z;
    if (!pinhole_ && x * x + y * y > fold_ * fold_) return std::nullopt;
    at = pinhole_ ? PixelPoint{x, y} : distort(x, y);
  }
  return PixelPoint{k_.fx * at.u + k_.cx, k_.fy * at.v + k_.cy};
}

// Newton's method, kept inside [0, fold] by bisection.
std::optional<double> Lens::invert_radial(double distorted) const {
  if (distorted > radial(fold_)) return std::nullopt;
  double low = 0, high = fold_, r = std::min(distorted, fold_);
  for (int i = 0; i < 100; ++i) {
    const double error = radial(r) - distorted;
    (error < 0 ? low : high) = r;
    double next = r - error / radial_slope(r);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::fabs(next - r) <= 1e-15 * (1 + r)) return next;
    r = next;
  }
  return r;
}

std::optional<Vec3> Lens::unfold(double x, double y) const {
  const double distorted = std::sqrt(x * x + y * y);
  const std::optional<double> theta = invert_radial(distorted);
  if (!theta) return std::nullopt;
  if (distorted == 0) return Vec3(0, 0, 1);
  const double side = quick::sin(*theta) / distorted;
  return Vec3(x * side, y * side, quick::cos(*theta));
}

// The radial part alone gives the start; then Newton's method in two dimensions.
std::optional<Vec3> Lens::undistort(double xd, double yd) const {
  const double distorted = std::sqrt(xd * xd + yd * yd);
  const double most = radial(fold_);
  const std::optional<double> start = invert_radial(std::min(distorted, most));
  const double share = distorted > 0 ? *start / distorted : 1;
  double x = xd * share, y = yd * share;
  const auto& d = k_.distortion;
  for (int i = 0; i < 30; ++i) {
    const PixelPoint at = distort(x, y);
    const double ex = at.u - xd, ey = at.v - yd;
    if (std::fabs(ex) + std::fabs(ey) < 1e-14) break;
    const double r2 = x * x + y * y;
    const double grown = 1 + r2 * (d[0] + r2 * (d[1] + r2 * d[4]));
    const double slope = d[0] + r2 * (2 * d[1] + r2 * 3 * d[4]);  // d grown / d r2
    const double xx = grown + 2 * x * x * slope + 2 * d[2] * y + 6 * d[3] * x;
    const double yy = grown + 2 * y * y * slope + 6 * d[2] * y + 2 * d[3] * x;
    const double xy = 2 * x * y * slope + 2 * d[2] * x + 2 * d[3] * y;
    const double det = xx * yy - xy * xy;
    if (!(det > 0)) return std::nullopt;
    x -= (yy * ex - xy * ey) / det;
    y -= (xx * ey - xy * ex) / det;
  }
  const PixelPoint at = distort(x, y);
  const bool found = std::fabs(at.u - xd) + std::fabs(at.v - yd) < 1e-9;
  if (!found || x * x + y * y > fold_ * fold_) return std::nullopt;
  return Vec3(x, y, 1);
}

std::optional<Vec3> Lens::direction(double u, double v) const {
  const double x = (u - k_.cx) / k_.fx, y = (v - k_.cy) / k_.fy;
  if (k_.lens == LensModel::fisheye) return unfold(x, y);
  if (pinhole_) return normalized(Vec3(x, y, 1));
  const std::optional<Vec3> slope = undistort(x, y);
  if (!slope) return std::nullopt;
  return normalized(*slope);
}

}  // namespace rubble
