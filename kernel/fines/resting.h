// Resting poses of a small shape on a surface: on one of its faces, or on several points of rough ground.
#pragma once

#include <optional>

#include "kernel/geometry/fine_shapes.h"
#include "kernel/queries/queries.h"

namespace rubble {

// Least cosine of a slope that anything stays on: 37 degrees, about what loose grit is poured at.
inline constexpr double kSteepestRest = 0.8;

// The plane that something rests on.
struct Support {
  Vec3 point, normal;       // in the world; unit: m; out of the surface
  int host = kGroundPiece;  // index of the piece below the middle
};

// The shortest turn that takes one unit vector to another.
Quat turn_between(const Vec3& from, const Vec3& to);

// Two directions along a plane of this normal, turned about it by `yaw` (unit: rad).
struct Tangents {
  Vec3 x, y;
};
Tangents make_tangents(const Vec3& normal, double yaw);

// What is straight below a point, if it faces up and is not met from inside. farthest: unit: m.
std::optional<RayHit> find_below(const PileQueries& queries, const Vec3& from, double farthest);

// World from shape: its largest face on the support, or with `flat` its lower z side, turned by `yaw` about the
// normal, in by a small share of its height. middle_height: of the origin above the support; unit: m.
Pose rest_on(const Support& support, const FineShape& shape, const Vec3f& half, bool flat, double yaw,
             double& middle_height);

// The plane that a stiff body of this reach (unit: m) rests on: through the highest of the places below its corners
// and middle. None where it would tip over an edge, lie too steeply or stand more than `gap` above one of them.
std::optional<Support> find_support(const PileQueries& queries, const RayHit& below, double reach, double yaw,
                                    double gap);

}  // namespace rubble
