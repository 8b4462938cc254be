// The judge of a settled pile: every pair of pieces on its true hulls, and every piece against the
// ground, without the kernel's collision code.
#pragma once

#include <vector>

#include "kernel/model/pile.h"
#include "kernel/model/pile_state.h"

namespace rubble {

// Two pieces touch when they overlap or come closer than this. The kernel keeps resting surfaces
// 1 mm apart, give or take its tolerance. unit: m
inline constexpr double kTouchGap = 0.002;

struct Overlap {
  int a = 0, b = 0;      // pieces, a < b
  double depth = 0;      // over all pairs of parts the largest; unit: m
  double ccd_depth = 0;  // of the same parts, by libccd; unit: m
};

struct OverlapReport {
  std::vector<Overlap> overlaps;  // deepest first
  int touching_pairs = 0;         // overlapping ones too
  double ground_max = 0;          // depth of the lowest corner below z = 0; unit: m
  int deepest_in_ground = -1;     // the piece with that corner

  int count_deeper(double depth) const;
  // Over the overlapping pairs; 0 when there is none. unit: m
  double mean_depth() const;
  double percentile_depth(double percent) const;
  double max_depth() const;
  // Largest difference between the two ways to find a depth. Where they differ it is libccd that
  // stopped early, in about one pair of ten, with a depth too small. unit: m
  double largest_disagreement() const;
};

// Lost pieces are left out, and so are pairs of immovable ones and pairs that a joint holds.
OverlapReport check_overlaps(const std::vector<PieceType>& types, const PileState& state,
                             double touch_gap = kTouchGap);

// The smallest value that at least `percent` of the values do not exceed; 0 for none.
double percentile(std::vector<double> values, double percent);

}  // namespace rubble
