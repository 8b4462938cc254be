// The free space of a layer that is being drawn: which placements keep clear of the others.
#pragma once

#include <map>
#include <tuple>
#include <vector>

#include "kernel/geometry/shape.h"
#include "kernel/model/pile.h"

namespace rubble {

class LayerSpace {
 public:
  // largest_radius: of any piece's bounding sphere, scale included; unit: m; > 0.
  LayerSpace(const ByKind<Shape>& shapes, double largest_radius);

  // True when the convex parts keep at least 1 cm away from those of every piece added so far.
  bool is_free(const Placement& placement) const;
  void add(const Placement& placement);

 private:
  // A piece with its parts' corners turned and scaled, relative to its centre of mass.
  struct Body {
    Vec3 centre;  // of mass; unit: m
    double radius = 0;
    std::vector<std::vector<Vec3f>> parts;
  };
  using Cell = std::tuple<long, long, long>;

  Body turn(const Placement& placement, bool with_parts) const;
  Cell cell_of(const Vec3& point) const;
  static bool are_apart(const Body& a, const Body& b);

  const ByKind<Shape>& shapes_;
  double cell_size_;
  std::map<Cell, std::vector<Body>> bodies_;
};

}  // namespace rubble
