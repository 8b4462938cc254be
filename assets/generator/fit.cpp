#include "assets/generator/fit.h"

#include <algorithm>
#include <cmath>

#include "assets/generator/polytope.h"
#include "kernel/base/error.h"

namespace rubble::generator {
namespace {

constexpr double kInside = 0.012;  // a corner deeper than this is within the solid; unit: m
constexpr double kMaxShrink = 0.02;  // of a face of a cell; unit: m
constexpr double kAnyShrink = 10;    // of a face of a region; unit: m
constexpr double kSink = 0.8;  // of the mean dent, by which a face goes below the highest bumps
constexpr double kMaxSink = 0.02;    // where holes count among the dents; unit: m
constexpr double kThinnestPart = 0.011;  // of a part; unit: m
constexpr double kWorthwhile = 0.001;  // a cut takes off more; unit: m
constexpr double kApart = 0.004;       // corners of a finished part are farther apart; unit: m

// Corners without those that crowd another, rounded as they will be written.
std::vector<Vec3> tidy(const std::vector<Vec3>& corners) {
  std::vector<Vec3> kept;
  for (const Vec3& c : corners) {
    const bool crowded = std::any_of(kept.begin(), kept.end(),
                                     [&](const Vec3& k) { return distance(k, c) < kApart; });
    if (!crowded) kept.push_back(rounded_for_file(c));
  }
  return kept;
}

bool in_cell(const Cell& cell, const Vec3& p) {
  return std::all_of(cell.begin(), cell.end(),
                     [&](const Face& f) { return dot(f.normal, p) < f.offset + 1e-3; });
}

double support(const std::vector<Vec3>& points, const Vec3& normal) {
  double top = -1e9;
  for (const Vec3& p : points) top = std::fmax(top, dot(normal, p));
  return top;
}

// For each face, the mean distance below it of the surface that belongs to it; negative where a
// face has none because it is inside the solid. unit: m
std::vector<double> mean_dents(const Cell& cell, const std::vector<Vec3>& points) {
  std::vector<double> sums(cell.size(), 0), counts(cell.size(), 0);
  for (const Vec3& p : points) {
    std::size_t nearest = 0;
    double highest = -1e9;
    for (std::size_t f = 0; f < cell.size(); ++f) {
      const double height = dot(cell[f].normal, p) - cell[f].offset;
      if (height > highest) highest = height, nearest = f;
    }
    sums[nearest] -= highest;
    counts[nearest] += 1;
  }
  for (std::size_t f = 0; f < cell.size(); ++f) sums[f] = counts[f] > 0 ? sums[f] / counts[f] : -1;
  return sums;
}

// The points that the part of a cell must contain: the surface inside it, and its own corners
// where they are buried in the rest of the solid.
std::vector<Vec3> points_to_keep(const Solid& solid, const Cell& cell, const SurfaceMesh& surface) {
  std::vector<Vec3> points;
  for (const Vec3& p : surface.positions) {
    if (in_cell(cell, p)) points.push_back(p);
  }
  for (const Vec3& corner : corners_of(cell)) {
    if (sample(whole_view(solid), corner, 0.05).value < -kInside) points.push_back(corner);
  }
  return points;
}

struct Gap {
  Vec3 corner;
  double size = 0;
  Vec3 outward;
};

// Distances from corners to the nearest of some points; each corner is looked up once.
class GapFinder {
 public:
  explicit GapFinder(const std::vector<Vec3>& points) : points_(points) {}

  Gap largest(const std::vector<Vec3>& corners) {
    Gap result;
    for (const Vec3& corner : corners) {
      const Gap& gap = find(corner);
      if (gap.size > result.size) result = gap;
    }
    return result;
  }

  void give_up(const Vec3& corner) {
    for (Gap& gap : known_) {
      if (gap.corner == corner) gap.size = 0;
    }
  }

 private:
  const Gap& find(const Vec3& corner) {
    for (const Gap& gap : known_) {
      if (gap.corner == corner) return gap;
    }
    Vec3 nearest;
    double best = 1e18;
    for (const Vec3& p : points_) {
      const Vec3 d = p - corner;
      if (dot(d, d) < best) best = dot(d, d), nearest = p;
    }
    known_.push_back({corner, std::sqrt(best), normalized(corner - nearest)});
    return known_.back();
  }

  const std::vector<Vec3>& points_;
  std::vector<Gap> known_;
};

std::vector<Vec3> fit_cell(Cell cell, const std::vector<Vec3>& points, double max_shrink) {
  const std::vector<double> dents = mean_dents(cell, points);
  for (std::size_t f = 0; f < cell.size(); ++f) {
    const double top = support(points, cell[f].normal);
    if (dents[f] < 0 || top < cell[f].offset - max_shrink) continue;
    const double below_top = dents[f] - (cell[f].offset - top);
    cell[f].offset = top - std::fmin(kMaxSink, kSink * below_top);
  }
  std::vector<Vec3> corners = corners_of(cell);
  GapFinder finder(points);
  for (int tries = 0; tries < 3 * kMaxCorners; ++tries) {
    const Gap gap = finder.largest(corners);
    if (gap.size < kCornerGap) break;
    const double top = support(points, gap.outward);
    if (dot(gap.outward, gap.corner) - top < kWorthwhile) {
      finder.give_up(gap.corner);  // other parts of the surface stand in the way
      continue;
    }
    cell.push_back({gap.outward, top});
    std::vector<Vec3> cut = corners_of(cell);
    if (static_cast<int>(cut.size()) > kMaxCorners) break;
    corners = std::move(cut);
  }
  return corners;
}

// The half-spaces of a region's hull where the warp puts its corners.
Cell hull_cell(const Cell& region, const Warp& warp) {
  std::vector<Vec3> corners = corners_of(region);
  for (Vec3& p : corners) p = warp(p);
  Cell cell;
  for (const Polygon& face : hull_faces(corners)) {
    cell.push_back({face.normal, dot(face.normal, corners[std::size_t(face.corners[0])])});
  }
  return cell;
}

}  // namespace

std::vector<std::vector<Vec3>> cell_parts(const Solid& solid) {
  std::vector<std::vector<Vec3>> parts;
  for (const Cell& cell : solid.cells) parts.push_back(tidy(corners_of(cell)));
  return parts;
}

std::vector<std::vector<Vec3>> fit_parts(const Solid& solid, const SurfaceMesh& surface) {
  std::vector<std::vector<Vec3>> parts;
  for (const Cell& cell : solid.cells) {
    parts.push_back(tidy(fit_cell(cell, points_to_keep(solid, cell, surface), kMaxShrink)));
  }
  return parts;
}

// Parts of crushed sheet may come out too thin to collide with: those are widened about their middle.
std::vector<Vec3> widened(std::vector<Vec3> part) {
  double least = 1e9;
  Vec3 across;
  for (const Polygon& face : hull_faces(part)) {
    const double top = support(part, face.normal), depth = top + support(part, -face.normal);
    if (depth < least) least = depth, across = face.normal;
  }
  if (least >= kThinnestPart) return part;
  const double middle = support(part, across) - 0.5 * least;
  for (Vec3& p : part) {
    const double height = dot(across, p) - middle;
    p += across * ((height > 0 ? 0.5 : -0.5) * (kThinnestPart - least));
  }
  return part;
}

std::vector<std::vector<Vec3>> fit_regions(const Solid& solid, const std::vector<Cell>& regions,
                                           const SurfaceMesh& surface, const Warp& warp) {
  std::vector<std::vector<Vec3>> parts;
  for (const Cell& region : regions) {
    std::vector<Vec3> points = points_to_keep(solid, region, surface);
    if (points.size() < 4) throw RunError("a region of a generated solid holds no surface");
    if (warp) {
      for (Vec3& p : points) p = warp(p);
    }
    const Cell cell = warp ? hull_cell(region, warp) : region;
    parts.push_back(widened(tidy(fit_cell(cell, points, kAnyShrink))));
  }
  return parts;
}

}  // namespace rubble::generator
