// The triangles of a pile's fixed surfaces (terrain), placed in the world, with a search by boxes.
#pragma once

#include <vector>

#include "kernel/model/pile.h"
#include "kernel/model/pile_state.h"

namespace rubble {

struct PlacedTriangle {
  int piece = 0;
  Vec3 corners[3];  // counter-clockwise seen from the side that is free; unit: m
  Vec3 normal;      // unit length
  Aabb box;
};

class PlacedSurfaces {
 public:
  PlacedSurfaces(const std::vector<PieceType>& types, const PileState& state);
  bool empty() const { return triangles_.empty(); }
  // Those whose boxes meet `box`.
  std::vector<const PlacedTriangle*> find(const Aabb& box) const;

 private:
  std::vector<PlacedTriangle> triangles_;  // by the lowest x
  double widest_ = 0;                      // along x, of any triangle
};

Vec3 closest_point(const PlacedTriangle& triangle, const Vec3& point);

}  // namespace rubble
