#include "heap_measures.h"

#include <algorithm>
#include <cmath>

#include "bench/true_hull.h"
#include "kernel/base/random.h"

namespace rubble {
namespace {

std::vector<PlacedHull> place_all(const std::vector<PieceType>& types, const PileState& state) {
  std::vector<PlacedHull> hulls;
  for (const PieceState& piece : state.pieces) {
    if (piece.status == PieceStatus::fixed || piece.status == PieceStatus::lost) continue;
    for (const ConvexPart& part : types[std::size_t(piece.type)].parts) {
      hulls.push_back(place_hull(make_true_hull(part.points), piece.scale, piece.world_from_body));
    }
  }
  return hulls;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

bool contains(const PlacedHull& hull, const Vec3& point) {
  for (const Vec3& n : hull.hull.face_normals) {
    double low = 1e300, high = -1e300;
    for (const Vec3& c : hull.hull.corners) {
      low = std::min(low, dot(c, n));
      high = std::max(high, dot(c, n));
    }
    const double d = dot(point, n);
    if (d < low || d > high) return false;
  }
  return true;
}

bool inside_box(const Aabb& box, const Vec3& p) {
  return p.x >= box.min.x && p.x <= box.max.x && p.y >= box.min.y && p.y <= box.max.y &&
         p.z >= box.min.z && p.z <= box.max.z;
}

}  // namespace

double calc_slope(const PileState& state) {
  std::vector<double> radii, heights;
  for (const PieceState& piece : state.pieces) {
    const Vec3& p = piece.world_from_body.translation;
    radii.push_back(std::hypot(p.x, p.y));
    heights.push_back(p.z);
  }
  const double radius = 2 * median(radii);
  const double height = median(heights) / (1 - std::cbrt(0.5));
  return std::atan(height / radius);
}

double calc_filled_share(const std::vector<PieceType>& types, const PileState& state,
                         const Aabb& box, int samples) {
  const std::vector<PlacedHull> hulls = place_all(types, state);
  RandomStream random(1, "filled share");
  int filled = 0;
  for (int i = 0; i < samples; ++i) {
    const Vec3 p{random.uniform(box.min.x, box.max.x), random.uniform(box.min.y, box.max.y),
                 random.uniform(box.min.z, box.max.z)};
    filled += std::any_of(hulls.begin(), hulls.end(), [&p](const PlacedHull& hull) {
      return inside_box(hull.box, p) && contains(hull, p);
    });
  }
  return double(filled) / samples;
}

}  // namespace rubble
