#include "bench/placed_parts.h"

#include <algorithm>
#include <numeric>

namespace rubble {

std::vector<PlacedPart> place_parts(const std::vector<PieceType>& types, const PileState& state) {
  std::vector<std::vector<TrueHull>> hulls;
  for (const PieceType& type : types) {
    hulls.emplace_back();
    for (const ConvexPart& part : type.parts) hulls.back().push_back(make_true_hull(part.points));
  }
  std::vector<PlacedPart> parts;
  for (std::size_t i = 0; i < state.pieces.size(); ++i) {
    const PieceState& piece = state.pieces[i];
    if (piece.status == PieceStatus::lost) continue;
    for (const TrueHull& hull : hulls[std::size_t(piece.type)]) {
      parts.push_back({int(i), piece.status == PieceStatus::fixed,
                       place_hull(hull, piece.scale, piece.world_from_body)});
    }
  }
  return parts;
}

// Sorted and swept along x.
void find_near_parts(const std::vector<PlacedPart>& parts, double gap, const VisitParts& visit) {
  std::vector<std::size_t> order(parts.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::sort(order.begin(), order.end(), [&parts](std::size_t i, std::size_t j) {
    return parts[i].hull.box.min.x < parts[j].hull.box.min.x;
  });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const PlacedPart& a = parts[order[i]];
    const Aabb& box = a.hull.box;
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      const PlacedPart& b = parts[order[j]];
      const Aabb& other = b.hull.box;
      if (other.min.x > box.max.x + gap) break;
      if (other.min.y > box.max.y + gap || box.min.y > other.max.y + gap ||
          other.min.z > box.max.z + gap || box.min.z > other.max.z + gap || a.piece == b.piece ||
          (a.fixed && b.fixed)) {
        continue;
      }
      visit(a, b);
    }
  }
}

}  // namespace rubble
