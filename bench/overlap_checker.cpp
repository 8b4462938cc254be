#include "bench/overlap_checker.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "bench/penetration.h"
#include "bench/placed_parts.h"

namespace rubble {
namespace {

// Pieces that a joint holds together are built into each other.
std::set<std::pair<int, int>> find_joined(const PileState& state) {
  std::set<std::pair<int, int>> joined;
  for (const JointState& joint : state.joints)
    joined.insert(std::minmax(int(joint.parent), int(joint.child)));
  return joined;
}

// One entry per pair of pieces, that of the deepest parts.
std::vector<Overlap> merge_parts(std::vector<Overlap> found) {
  std::sort(found.begin(), found.end(), [](const Overlap& p, const Overlap& q) {
    return std::make_tuple(p.a, p.b, -p.depth) < std::make_tuple(q.a, q.b, -q.depth);
  });
  const auto same = [](const Overlap& p, const Overlap& q) { return p.a == q.a && p.b == q.b; };
  found.erase(std::unique(found.begin(), found.end(), same), found.end());
  return found;
}

}  // namespace

OverlapReport check_overlaps(const std::vector<PieceType>& types, const PileState& state,
                             double touch_gap) {
  const std::vector<PlacedPart> parts = place_parts(types, state);
  const std::set<std::pair<int, int>> joined = find_joined(state);
  std::vector<Overlap> touching;
  find_near_parts(parts, touch_gap, [&](const PlacedPart& a, const PlacedPart& b) {
    if (joined.count(std::minmax(a.piece, b.piece))) return;
    const double depth = calc_penetration(a.hull, b.hull).depth;
    if (depth < -touch_gap) return;
    if (depth <= 0 && !closer_than_ccd(a.hull, b.hull, touch_gap)) return;
    const double ccd_depth = depth > 0 ? calc_depth_ccd(a.hull, b.hull) : 0;
    touching.push_back(
        {std::min(a.piece, b.piece), std::max(a.piece, b.piece), std::max(depth, 0.0), ccd_depth});
  });
  OverlapReport report;
  for (const Overlap& pair : merge_parts(std::move(touching))) {
    ++report.touching_pairs;
    if (pair.depth > 0) report.overlaps.push_back(pair);
  }
  std::stable_sort(report.overlaps.begin(), report.overlaps.end(),
                   [](const Overlap& p, const Overlap& q) { return p.depth > q.depth; });
  for (const PlacedPart& part : parts) {
    if (part.fixed || -part.hull.box.min.z <= report.ground_max) continue;
    report.ground_max = -part.hull.box.min.z;
    report.deepest_in_ground = part.piece;
  }
  return report;
}

int OverlapReport::count_deeper(double depth) const {
  return int(std::count_if(overlaps.begin(), overlaps.end(),
                           [depth](const Overlap& o) { return o.depth > depth; }));
}

double OverlapReport::mean_depth() const {
  double sum = 0;
  for (const Overlap& o : overlaps) sum += o.depth;
  return overlaps.empty() ? 0 : sum / double(overlaps.size());
}

double OverlapReport::percentile_depth(double percent) const {
  std::vector<double> depths;
  for (const Overlap& o : overlaps) depths.push_back(o.depth);
  return percentile(std::move(depths), percent);
}

double OverlapReport::max_depth() const { return overlaps.empty() ? 0 : overlaps.front().depth; }

double OverlapReport::largest_disagreement() const {
  double largest = 0;
  for (const Overlap& o : overlaps) largest = std::max(largest, std::abs(o.depth - o.ccd_depth));
  return largest;
}

double percentile(std::vector<double> values, double percent) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const double rank = std::ceil(percent / 100 * double(values.size()));
  const auto index = std::size_t(std::max(rank, 1.0)) - 1;
  return values[std::min(index, values.size() - 1)];
}

}  // namespace rubble
