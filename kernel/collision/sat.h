// Separating axis search over all faces and edge pairs: slow and sure, for overlapping parts.
#pragma once

#include "kernel/base/math.h"
#include "kernel/collision/gjk.h"
#include "kernel/geometry/shape.h"

namespace rubble {

// A part in world orientation; corners relative to the centre of mass of its piece.
struct PosedPart {
  const ConvexShape* shape = nullptr;  // at scale 1, in the frame of the piece's body
  PointSet corners;                    // of the shape, scaled and turned to the world; unit: m
  const Mat3f* rotation = nullptr;     // world from body
  const Shape* piece = nullptr;        // all parts of the piece; none: this part is alone
  float scale = 1;                     // of the piece

  Vec3f face_normal(int face) const { return *rotation * shape->faces[face].normal; }
  // The face whose normal is nearest to a direction given in the world.
  int find_face(const Vec3f& direction) const;
  // Whether a point, relative to the centre of mass, is inside another part of the piece.
  bool is_inside_sibling(const Vec3f& point) const;
};

struct SatResult {
  Vec3f normal;          // unit length, from A to B
  float separation = 0;  // along it; negative: overlap depth; unit: m
  Vec3f point;           // midway between the features that meet
};

// The axis of greatest separation; `offset` is added to B's corners. Of parts that overlap by more than
// a few millimetres, one that leads out of both pieces, where there is one: the shortest way out of a
// part may lead into the next part of the same piece, and what follows it never comes out.
SatResult find_separating_axis(const PosedPart& a, const PosedPart& b, const Vec3f& offset);

}  // namespace rubble
