#include "bench/equilibrium/contact_finder.h"

#include <algorithm>
#include <map>

#include "bench/equilibrium/contact_patch.h"
#include "bench/equilibrium/placed_surface.h"
#include "bench/penetration.h"

namespace rubble {
namespace {

constexpr double kDeepest = 0.1;  // what is farther behind a triangle is on its other side; unit: m

// The regions of parts, made when they are first asked for.
class Regions {
 public:
  const ConvexRegion& of(const PlacedPart& part) {
    const auto found = regions_.find(&part);
    if (found != regions_.end()) return found->second;
    return regions_[&part] = make_region(part.hull);
  }

 private:
  std::map<const PlacedPart*, ConvexRegion> regions_;
};

class Finder {
 public:
  Finder(const PiecePairs& apart, double tolerance) : apart_(apart), tolerance_(tolerance) {}

  void touch_parts(const PlacedPart& a, const PlacedPart& b) {
    if (apart_.count(std::minmax(a.piece, b.piece))) return;
    const Penetration found = calc_penetration(a.hull, b.hull, tolerance_);
    if (found.depth < -tolerance_) return;
    add(a.piece, b.piece, found.direction, -found.depth,
        find_patch(regions_.of(a), regions_.of(b), found.direction, reach(found.depth)));
  }

  void touch_ground(const PlacedPart& part) {
    if (part.hull.box.min.z > tolerance_) return;
    const Vec3 up{0, 0, 1};
    const double gap = part.hull.box.min.z;
    add(kGroundPiece, part.piece, up, gap,
        find_patch({{{up, 0}}, {}}, regions_.of(part), up, reach(-gap)));
  }

  void touch_surfaces(const PlacedPart& part, const PlacedSurfaces& surfaces) {
    Aabb box = part.hull.box;
    const Vec3 margin{tolerance_, tolerance_, tolerance_};
    box.min -= margin;
    box.max += margin;
    for (const PlacedTriangle* t : surfaces.find(box)) {
      const ConvexRegion column = make_column(t->corners, t->normal, kDeepest);
      const ConvexRegion& region = regions_.of(part);
      const double gap = 0;  // see find_surface_depth()
      add(t->piece, part.piece, t->normal, gap,
          find_patch(column, region, t->normal, tolerance_));
    }
  }

  std::vector<TouchPoint> take() { return std::move(points_); }

 private:
  // What overlaps by more than the tolerance touches where it is deepest, not in all of it.
  double reach(double depth) const { return tolerance_ - std::max(depth - tolerance_, 0.0); }

  void add(int a, int b, const Vec3& normal, double gap, const std::vector<Vec3>& patch) {
    for (const Vec3& point : patch) points_.push_back({a, b, point, normal, gap});
  }

  const PiecePairs& apart_;
  double tolerance_;
  Regions regions_;
  std::vector<TouchPoint> points_;
};

// Below the side that the nearest triangle faces; 0 above it or far from all.
double depth_of_corner(const PlacedSurfaces& surfaces, const Vec3& corner) {
  Aabb box;
  const Vec3 margin{kDeepest, kDeepest, kDeepest};
  box.include(corner - margin);
  box.include(corner + margin);
  double nearest = 1e300, depth = 0;
  for (const PlacedTriangle* t : surfaces.find(box)) {
    const double away = distance(closest_point(*t, corner), corner);
    if (away >= nearest) continue;
    nearest = away;
    depth = dot(corner - t->corners[0], t->normal) < 0 ? away : 0;
  }
  return depth;
}

double depth_in_hull(const ConvexRegion& region, const Vec3& point) {
  double depth = 1e300;
  for (const RegionPlane& plane : region.planes)
    depth = std::min(depth, plane.offset - dot(plane.normal, point));
  return std::max(depth, 0.0);
}

}  // namespace

std::vector<TouchPoint> find_touch_points(const std::vector<PieceType>& types,
                                          const PileState& state, const PiecePairs& apart,
                                          double tolerance) {
  const std::vector<PlacedPart> parts = place_parts(types, state);
  const PlacedSurfaces surfaces(types, state);
  Finder finder(apart, tolerance);
  find_near_parts(parts, tolerance, [&](const PlacedPart& a, const PlacedPart& b) {
    finder.touch_parts(a, b);
  });
  for (const PlacedPart& part : parts) {
    if (part.fixed) continue;
    finder.touch_ground(part);
    if (!surfaces.empty()) finder.touch_surfaces(part, surfaces);
  }
  return finder.take();
}

SurfaceDepth find_surface_depth(const std::vector<PieceType>& types, const PileState& state) {
  SurfaceDepth deepest;
  const PlacedSurfaces surfaces(types, state);
  if (surfaces.empty()) return deepest;
  for (const PlacedPart& part : place_parts(types, state)) {
    if (part.fixed) continue;
    double depth = 0;
    for (const Vec3& corner : part.hull.hull.corners)
      depth = std::max(depth, depth_of_corner(surfaces, corner));
    const ConvexRegion region = make_region(part.hull);
    for (const PlacedTriangle* t : surfaces.find(part.hull.box))
      for (const Vec3& corner : t->corners) depth = std::max(depth, depth_in_hull(region, corner));
    if (depth > deepest.depth) deepest = {depth, part.piece};
  }
  return deepest;
}

}  // namespace rubble
