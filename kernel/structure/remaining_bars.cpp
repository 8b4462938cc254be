#include "kernel/structure/remaining_bars.h"

#include <algorithm>
#include <cmath>

namespace rubble {
namespace {

constexpr double kEmbedded = 0.15;  // from the section to where a bar is held in a piece; unit: m
constexpr double kWide = 2;         // sections this many times as wide as deep have two ties; unit: 1
// Concrete that spalls frees the bars: they bear again after the pieces have parted by this share of the
// section's depth, or turned by about 0.4 rad. Catenary action of floors begins no earlier. unit: 1
constexpr double kFreed = 0.2;
// Bars yield over some 12 diameters on either side of a crack and reach 7.5 % there: class C of EN
// 1992-1-1, annex C. unit: m
constexpr double kRuptureStretch = 0.075 * 0.4;
// Plastic moment of round bars against their force: fy d^3 / 6 against fy pi d^2 / 4, for d of 14 mm. unit: m
constexpr double kBarLever = 0.014 * 2 / (3 * 3.14159265358979);

// Between a piece's middle and its surface, however small it is.
double embedment(const Structure& structure, std::int32_t piece, const Section& s) {
  if (piece == kFoundation) return kEmbedded;
  const double to_middle = std::abs(dot(structure.pieces[piece].centre - s.centroid, s.normal));
  return std::min(kEmbedded, 0.5 * to_middle);
}

}  // namespace

std::vector<TieState> find_remaining_bars(const Structure& structure, const Bond& bond, double continuity) {
  const Section& s = bond.section;
  const double strength = continuity * s.steel.area * s.steel.yield;
  if (!(strength > 0)) return {};
  const double depth = 2 * std::min(s.half_s, s.half_t), width = 2 * std::max(s.half_s, s.half_t);
  const Vec3 across = s.half_s > s.half_t ? s.axis_s : s.axis_t;
  const double in_a = embedment(structure, bond.piece_a, s), in_b = embedment(structure, bond.piece_b, s);
  TieState tie;
  tie.piece_a = bond.piece_a, tie.piece_b = bond.piece_b;
  tie.length = in_a + in_b + kFreed * depth;
  tie.stretch = kRuptureStretch;
  const bool two = width > kWide * depth;
  tie.strength = strength / (two ? 2 : 1);
  tie.bending = tie.strength * kBarLever;
  std::vector<TieState> ties;
  for (const double side : {-1.0, 1.0}) {
    const Vec3 place = s.centroid + across * (two ? side * width / 4 : 0);
    const Vec3 a = place - s.normal * in_a, b = place + s.normal * in_b;
    tie.anchor_a = a - structure.pieces[bond.piece_a].position;
    tie.anchor_b = bond.piece_b == kFoundation ? b : b - structure.pieces[bond.piece_b].position;
    ties.push_back(tie);
    if (!two) break;
  }
  return ties;
}

}  // namespace rubble
