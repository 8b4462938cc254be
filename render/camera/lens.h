// How a lens maps directions to pixels, and back.
//
// With (X, Y, Z) in the optical frame, the pixel is u = fx x' + cx, v = fy y' + cy, where
//   plumb_bob (Brown 1966, as OpenCV calib3d): x = X/Z, y = Y/Z, r2 = x2 + y2,
//     x' = x (1 + k1 r2 + k2 r4 + k3 r6) + 2 p1 x y + p2 (r2 + 2 x2),
//     y' = y (1 + k1 r2 + k2 r4 + k3 r6) + p1 (r2 + 2 y2) + 2 p2 x y;
//   fisheye (Kannala and Brandt 2006, as OpenCV cv::fisheye): theta is the angle from the axis,
//     theta' = theta (1 + k1 theta2 + k2 theta4 + k3 theta6 + k4 theta8),
//     (x', y') = theta' (X, Y) / |(X, Y)|.
// A polynomial folds back where it stops growing; what lies beyond is no part of the model: no
// point projects there, and a pixel there sees nothing.
#pragma once

#include <optional>

#include "kernel/base/math.h"
#include "render/scene/frame.h"

namespace rubble {

struct PixelPoint {
  double u = 0, v = 0;  // unit: pixel
};

class Lens {
 public:
  explicit Lens(const Intrinsics& intrinsics);

  // Where a point of the optical frame appears, inside the image or beside it; nothing behind a
  // plumb_bob camera or beyond the fold.
  std::optional<PixelPoint> project(const Vec3& point) const;
  // The unit direction, in the optical frame, that a pixel looks in. The inverse of project() to
  // within 1e-9 of a pixel's angle; nothing beyond the fold.
  std::optional<Vec3> direction(double u, double v) const;

  bool is_pinhole() const { return pinhole_; }

 private:
  PixelPoint distort(double x, double y) const;  // plumb_bob, normalised coordinates
  std::optional<Vec3> undistort(double x, double y) const;
  std::optional<Vec3> unfold(double x, double y) const;  // fisheye
  double radial(double r) const;        // r' of r, or theta' of theta
  double radial_slope(double r) const;  // its derivative
  std::optional<double> invert_radial(double distorted) const;
  double find_fold() const;

  Intrinsics k_;
  bool pinhole_ = false;
  double fold_ = 0;  // largest r or theta of the model
};

}  // namespace rubble
