#include "app/navigate_ros1/scan_matcher.h"

#include <algorithm>
#include <cmath>

namespace rubble {
namespace {

// A search in steps around the best so far; unit: m, rad.
struct Search {
  int turns, moves;  // steps to either side
  double turn, move;
};
constexpr Search kSearches[]{{6, 2, 0.02, 0.05}, {3, 2, 0.005, 0.02}, {2, 1, 0.002, 0.01}};
constexpr double kLeastShare = 0.35;  // of points in occupied cells: with less the scan shows other things than the map
// That a share must be higher by, to be believed more than the guess: what comes into sight lies ahead, and pulls matches
// back to what was seen before, while odometry knows well how far it went, and badly how much it turned.
constexpr double kPriorOfPlace = 0.8, kPriorOfTurn = 1.5;  // unit: 1/m, 1/rad
constexpr std::size_t kFewestMatched = 50;   // points

double share_of(const PlanarMap& map, const std::vector<Vec3>& turned, double x, double y) {
  double sum = 0;
  for (const Vec3& p : turned) sum += map.value(p.x + x, p.y + y);
  return sum / double(turned.size());
}

std::vector<Vec3> turned_by(double yaw, const std::vector<Vec3>& points) {
  const PlanarPose turn{0, 0, yaw};
  std::vector<Vec3> turned;
  turned.reserve(points.size());
  for (const Vec3& p : points) turned.push_back(turn * p);
  return turned;
}

double doubt_of(const PlanarPose& guess, const PlanarPose& pose) {
  return kPriorOfPlace * std::hypot(pose.x - guess.x, pose.y - guess.y) +
         kPriorOfTurn * std::fabs(wrapped(pose.yaw - guess.yaw));
}

}  // namespace

PlanarMap::PlanarMap(const Aabb& bounds, double voxel) {
  grid_.voxel = voxel, grid_.corner = {bounds.min.x, bounds.min.y, -0.5 * voxel};
  const Vec3 size = (bounds.max - bounds.min) * (1 / voxel);
  grid_.size = {std::max(1, int(size.x)), std::max(1, int(size.y)), 1};
  halves_.assign(grid_.count(), 0);
}

void PlanarMap::mark(const Cell& cell, std::uint8_t halves) {
  if (!grid_.contains(cell)) return;
  std::uint8_t& marked = halves_[grid_.index(cell)];
  marked = std::max(marked, halves);
}

void PlanarMap::add(const Vec3& place) {
  const Cell cell = grid_.find_cell({place.x, place.y, 0});
  if (!holds(place)) return;
  mark(cell, 2);
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) mark({cell[0] + x, cell[1] + y, 0}, 1);
}

double PlanarMap::value(double x, double y) const {
  const Cell cell = grid_.find_cell({x, y, 0});
  return grid_.contains(cell) ? 0.5 * halves_[grid_.index(cell)] : 0;
}

ScanMatch match_scan(const PlanarMap& map, const std::vector<Vec3>& points, const PlanarPose& guess) {
  if (points.size() < kFewestMatched) return {guess, false, 0};
  ScanMatch best{guess, true, share_of(map, turned_by(guess.yaw, points), guess.x, guess.y)};
  double best_score = best.share;
  for (const Search& search : kSearches) {
    const PlanarPose middle = best.pose;
    for (int turn = -search.turns; turn <= search.turns; ++turn) {
      const double yaw = wrapped(middle.yaw + turn * search.turn);
      const std::vector<Vec3> turned = turned_by(yaw, points);
      for (int i = -search.moves; i <= search.moves; ++i)
        for (int k = -search.moves; k <= search.moves; ++k) {
          const PlanarPose pose{middle.x + i * search.move, middle.y + k * search.move, yaw};
          const double share = share_of(map, turned, pose.x, pose.y), score = share - doubt_of(guess, pose);
          if (score > best_score) best = {pose, true, share}, best_score = score;
        }
    }
  }
  return best.share < kLeastShare ? ScanMatch{guess, false, best.share} : best;
}

}  // namespace rubble
