#include "kernel/collision/placed_overlaps.h"

#include <algorithm>
#include <map>

#include "kernel/collision/sat.h"
#include "kernel/geometry/shape.h"

namespace rubble {
namespace {

// A placement with the corners of its parts turned to the world, from its centre of mass.
struct PosedPiece {
  int index = 0;  // of the placement
  const Shape* shape = nullptr;
  Vec3 centre;
  Mat3f rotation;
  Aabb box;
  std::vector<std::vector<Vec3f>> corners;  // by part

  PosedPart part(std::size_t i, double scale) const {
    return {&shape->parts[i], {corners[i].data(), int(corners[i].size())}, &rotation, shape, float(scale)};
  }
};

PosedPiece pose(int index, const Placement& placement, const Shape& shape) {
  const Pose& pose = placement.world_from_body;
  PosedPiece piece;
  piece.index = index;
  piece.shape = &shape;
  piece.centre = pose * (shape.volume.centre_of_mass * placement.scale);
  piece.rotation = to_float(pose.rotation.matrix());
  for (const ConvexShape& part : shape.parts) {
    piece.corners.emplace_back();
    for (const Vec3f& corner : part.corners) {
      piece.corners.back().push_back(piece.rotation * (corner * float(placement.scale)));
      piece.box.include(piece.centre + Vec3(piece.corners.back().back()));
    }
  }
  return piece;
}

bool are_near(const Aabb& a, const Aabb& b, double least) {
  for (int k = 0; k < 3; ++k)
    if (a.min[k] + least > b.max[k] || b.min[k] + least > a.max[k]) return false;
  return true;
}

double calc_depth(const PosedPiece& a, double scale_a, const PosedPiece& b, double scale_b) {
  const Vec3f offset(b.centre - a.centre);
  double depth = 0;
  for (std::size_t i = 0; i < a.corners.size(); ++i)
    for (std::size_t k = 0; k < b.corners.size(); ++k)
      depth = std::max(depth, -double(find_separating_axis(a.part(i, scale_a), b.part(k, scale_b), offset).separation));
  return depth;
}

}  // namespace

std::vector<PlacedOverlap> find_placed_overlaps(const std::vector<PieceType>& types, const std::vector<Placement>& placed,
                                                std::size_t own, double least) {
  std::map<int, Shape> shapes;
  std::vector<PosedPiece> pieces;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    const int type = placed[i].kind.index;
    if (placed[i].kind.is_assembly || types[std::size_t(type)].surface) continue;
    const auto [shape, is_new] = shapes.try_emplace(type);
    if (is_new) shape->second = compile_shape(types[std::size_t(type)], types[std::size_t(type)].name);
    pieces.push_back(pose(int(i), placed[i], shape->second));
  }
  std::vector<PlacedOverlap> overlaps;
  for (std::size_t i = 0; i < pieces.size() && std::size_t(pieces[i].index) < own; ++i)
    for (std::size_t k = i + 1; k < pieces.size(); ++k) {
      const PosedPiece &a = pieces[i], &b = pieces[k];
      if (!are_near(a.box, b.box, least)) continue;
      const double depth = calc_depth(a, placed[std::size_t(a.index)].scale, b, placed[std::size_t(b.index)].scale);
      if (depth > least) overlaps.push_back({a.index, b.index, depth});
    }
  std::stable_sort(overlaps.begin(), overlaps.end(),
                   [](const PlacedOverlap& a, const PlacedOverlap& b) { return a.depth > b.depth; });
  return overlaps;
}

}  // namespace rubble
