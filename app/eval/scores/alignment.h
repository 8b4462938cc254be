// The similarity that brings one set of points nearest to another.
#pragma once

#include <optional>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

// y = scale * rotation(x) + translation
struct Similarity {
  double scale = 1;  // unit: 1; above 0
  Quat rotation;     // unit length
  Vec3 translation;  // in the frame of y; unit: m

  Vec3 operator*(const Vec3& x) const { return scale * rotation.rotate(x) + translation; }
  Pose operator*(const Pose& pose) const {
    return {rotation * pose.rotation, *this * pose.translation};
  }
};

// Least squares over pairs from[i] -> to[i] (Horn 1987, "Closed-form solution of absolute
// orientation using unit quaternions"; the same optimum as Umeyama 1991). with_scale: a similarity
// of 7 parameters; else a rigid motion of 6, with scale 1. Nothing when the points do not determine
// it: fewer than 3, or all of either set on one line.
std::optional<Similarity> align_points(const std::vector<Vec3>& from, const std::vector<Vec3>& to,
                                       bool with_scale);

// As align_points, for distances alone: points on one line leave the turn about it open, and one of the
// best is taken, since all have the same distances. Nothing for fewer than 3, or all of a set at one place.
std::optional<Similarity> align_for_distances(const std::vector<Vec3>& from, const std::vector<Vec3>& to,
                                              bool with_scale);

}  // namespace rubble
