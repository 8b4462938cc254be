#include "kernel/geometry/decompose.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "kernel/base/error.h"
#include "kernel/geometry/decompose_exact.h"
#include "kernel/geometry/decompose_voxels.h"
#include "kernel/geometry/hull.h"

namespace rubble {
namespace {

using decomposing::Box;
using decomposing::calc_hull_volume;
using decomposing::Cell3;
using decomposing::Voxels;

constexpr int kPlanesPerAxis = 12;  // that are tried for a cut
constexpr double kBalance = 0.02;   // of the hull, that an uneven cut must save besides

using Points = std::vector<Vec3>;

struct Leaf {
  Box box;
  Voxels::Fill fill;
};

bool is_empty(const Box& box) { return box.low[0] >= box.high[0]; }

struct Cut {
  Leaf below, above;
  double cost = 1e300;  // hull volumes of both
};

// The best of some planes across each axis; cost stays huge when the box is too small to cut.
Cut find_cut(const Voxels& voxels, const Leaf& leaf) {
  Cut best;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int low = leaf.box.low[axis], high = leaf.box.high[axis];
    const int step = std::max(1, (high - low) / kPlanesPerAxis);
    for (int at = low + step; at < high; at += step) {
      Box below = leaf.box, above = leaf.box;
      below.high[axis] = above.low[axis] = at;
      below = voxels.tight(below), above = voxels.tight(above);
      if (is_empty(below) || is_empty(above)) continue;
      const Leaf a{below, voxels.measure(below)}, b{above, voxels.measure(above)};
      const double uneven = std::fabs(a.fill.voxels - b.fill.voxels) / leaf.fill.voxels;
      const double cost = a.fill.hull + b.fill.hull + kBalance * uneven * leaf.fill.hull;
      if (cost < best.cost) best = {a, b, cost};
    }
  }
  return best;
}

std::vector<Leaf> cut_up(const Voxels& voxels, const DecomposeOptions& options) {
  Box whole{{0, 0, 0}, voxels.size()};
  whole = voxels.tight(whole);
  std::vector<Leaf> leaves{{whole, voxels.measure(whole)}};
  const double tolerated = options.tolerance * leaves[0].fill.voxels;
  // Twice as many as wanted: joining afterwards mends cuts that went too far.
  const std::size_t most = std::size_t(2 * options.max_parts);
  std::vector<bool> final(1, false);
  while (leaves.size() < most) {
    double total = 0, worst = 0;
    std::size_t chosen = leaves.size();
    for (std::size_t i = 0; i < leaves.size(); ++i) {
      total += std::max(0.0, leaves[i].fill.excess());
      if (!final[i] && leaves[i].fill.excess() > worst) worst = leaves[i].fill.excess(), chosen = i;
    }
    if (chosen == leaves.size() || total < tolerated) break;
    const Cut cut = find_cut(voxels, leaves[chosen]);
    // A cut that saves nothing yet is right too: the halves of a ring are as large as the ring.
    if (cut.cost > 1e299) {
      final[chosen] = true;
      continue;
    }
    leaves[chosen] = cut.below;
    leaves.insert(leaves.begin() + long(chosen) + 1, cut.above);
    final.insert(final.begin() + long(chosen) + 1, false);
  }
  return leaves;
}

// What is left of a convex polygon on one side of a plane across an axis.
Points clip(const Points& polygon, int axis, double at, double side) {
  Points kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double ha = side * (a[axis] - at), hb = side * (b[axis] - at);
    if (ha <= 0) kept.push_back(a);
    if ((ha < 0 && hb > 0) || (ha > 0 && hb < 0)) {
      Vec3 p = a + (b - a) * (ha / (ha - hb));
      p[axis] = at;
      kept.push_back(p);
    }
  }
  return kept;
}

// The exact surface within the box, and the box's corners that are inside the solid.
Points points_in(const TriangleMesh& mesh, const Voxels& voxels, const Box& box) {
  const Vec3 low = voxels.position(box.low), high = voxels.position(box.high);
  Points points;
  for (const auto& t : mesh.triangles) {
    Points polygon;
    for (const auto v : t) polygon.push_back(Vec3(mesh.positions[v]));
    for (int axis = 0; axis < 3 && !polygon.empty(); ++axis) {
      polygon = clip(polygon, axis, low[axis], -1);
      polygon = clip(polygon, axis, high[axis], 1);
    }
    points.insert(points.end(), polygon.begin(), polygon.end());
  }
  for (int i = 0; i < 8; ++i) {
    Cell3 corner;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      corner[axis] = i >> axis & 1 ? box.high[axis] : box.low[axis];
    }
    if (voxels.surely_inside(corner)) points.push_back(voxels.position(corner));
  }
  return points;
}

struct Plane {
  Vec3 normal;
  double offset;
};

std::vector<Plane> planes_of(const Hull& hull) {
  std::vector<Plane> planes;
  for (const std::vector<int>& face : hull.faces) {
    Vec3 area;
    const Vec3& a = hull.points[std::size_t(face[0])];
    for (std::size_t k = 2; k < face.size(); ++k) {
      area += cross(hull.points[std::size_t(face[k - 1])] - a, hull.points[std::size_t(face[k])] - a);
    }
    const Vec3 n = normalized(area);
    planes.push_back({n, dot(n, a)});
  }
  return planes;
}

// Flat points get the thickness that collision needs; empty when they lie in a line.
Points thickened(const Points& points, double thickness) {
  if (points.empty()) return {};
  const Vec3 far = *std::max_element(points.begin(), points.end(), [&](const Vec3& a, const Vec3& b) {
    return distance(a, points[0]) < distance(b, points[0]);
  });
  Vec3 normal;
  for (const Vec3& p : points) {
    const Vec3 area = cross(p - points[0], far - points[0]);
    if (dot(area, area) > dot(normal, normal)) normal = area;
  }
  if (dot(normal, normal) < 1e-16) return {};
  Points both;
  for (const Vec3& p : points) {
    for (const double side : {0.5, -0.5}) both.push_back(p + normalized(normal) * (side * thickness));
  }
  return both;
}

// At most `count` of the hull's corners: extremes first, then whatever stands out farthest.
Points choose_corners(const Points& points, int count) {
  Points kept;
  const auto keep = [&](const Vec3& p) {
    if (std::find(kept.begin(), kept.end(), p) == kept.end()) kept.push_back(p);
  };
  for (int i = 0; i < 14; ++i) {
    static const int kAxes[7][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1},
                                    {1, -1, 1}, {1, 1, -1}, {1, -1, -1}};
    const Vec3 d = Vec3(kAxes[i / 2][0], kAxes[i / 2][1], kAxes[i / 2][2]) * (i % 2 ? -1.0 : 1.0);
    keep(*std::max_element(points.begin(), points.end(), [&](const Vec3& a, const Vec3& b) {
      return dot(d, a) < dot(d, b);
    }));
  }
  while (int(kept.size()) < count) {
    const std::vector<Plane> planes = planes_of(calc_hull(kept));
    double highest = 5e-4;  // half a millimetre more is no gain
    const Vec3* farthest = nullptr;
    for (const Vec3& p : points) {
      double height = -1e300;
      for (const Plane& plane : planes) height = std::max(height, dot(plane.normal, p) - plane.offset);
      if (height > highest) highest = height, farthest = &p;
    }
    if (!farthest) break;
    kept.push_back(*farthest);
  }
  return calc_hull(kept).points;
}

// Widened across its thinnest direction to what collision needs.
Points widened(Points points, double thinnest) {
  const std::vector<Plane> planes = planes_of(calc_hull(points));
  double least = 1e300, middle = 0;
  Vec3 across;
  for (const Plane& plane : planes) {
    double depth = 0;
    for (const Vec3& p : points) depth = std::max(depth, plane.offset - dot(plane.normal, p));
    if (depth < least) least = depth, across = plane.normal, middle = plane.offset - 0.5 * depth;
  }
  if (least >= thinnest) return points;
  for (Vec3& p : points) {
    p += across * ((dot(across, p) > middle ? 0.5 : -0.5) * (thinnest - least));
  }
  return calc_hull(points).points;
}

Points make_part(Points points, const DecomposeOptions& options) {
  if (calc_hull_volume(points) <= 0) points = thickened(points, options.thinnest);
  if (calc_hull_volume(points) <= 0) return {};
  try {
    return widened(choose_corners(points, options.max_corners), options.thinnest);
  } catch (const std::invalid_argument&) {
    return {};  // thinner than the hull's lattice tells
  }
}

// Joins the pair whose common hull is larger by least, until few enough are left and any further
// one would stand out of the mesh.
void join_parts(std::vector<Points>& parts, const DecomposeOptions& options) {
  std::vector<double> volumes;
  double total = 0;
  for (const Points& part : parts) volumes.push_back(calc_hull_volume(part)), total += volumes.back();
  // The growth of each pair, computed once; infinite for pairs that were joined away.
  const std::size_t count = parts.size();
  std::vector<double> growth(count * count, 1e300);
  const auto both = [&](std::size_t i, std::size_t j) {
    Points points = parts[i];
    points.insert(points.end(), parts[j].begin(), parts[j].end());
    return points;
  };
  const auto update = [&](std::size_t i, std::size_t j) {
    growth[i * count + j] = calc_hull_volume(both(i, j)) - volumes[i] - volumes[j];
  };
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = i + 1; j < count; ++j) update(i, j);
  }
  std::size_t left = count;
  while (left > 1) {
    const std::size_t best = std::size_t(std::min_element(growth.begin(), growth.end()) - growth.begin());
    const std::size_t i = best / count, j = best % count;
    const bool cheap = growth[best] < 0.1 * options.tolerance * total;
    if (growth[best] > 1e299 || (left <= std::size_t(options.max_parts) && !cheap)) break;
    parts[i] = make_part(both(i, j), options);
    volumes[i] = calc_hull_volume(parts[i]);
    parts[j].clear();
    --left;
    for (std::size_t k = 0; k < count; ++k) {
      growth[std::min(j, k) * count + std::max(j, k)] = 1e300;
      if (k != i && !parts[k].empty()) update(std::min(i, k), std::max(i, k));
    }
  }
  parts.erase(std::remove_if(parts.begin(), parts.end(), [](const Points& p) { return p.empty(); }),
              parts.end());
}

}  // namespace

std::vector<ConvexPart> decompose(const TriangleMesh& mesh, const DecomposeOptions& options) {
  std::vector<ConvexPart> exact;
  for (Points& part : decomposing::find_exact_parts(mesh, options.max_parts, options.max_corners))
    exact.push_back({widened(std::move(part), options.thinnest)});
  if (!exact.empty()) return exact;
  const Voxels voxels(mesh, options.resolution);
  std::vector<Points> parts;
  for (const Leaf& leaf : cut_up(voxels, options)) {
    Points part = make_part(points_in(mesh, voxels, leaf.box), options);
    if (!part.empty()) parts.push_back(std::move(part));
  }
  if (parts.empty()) {
    throw InputError({"", 0, "", "the mesh cannot be cut into convex parts", "a mesh with a volume",
                      "points in one line or one place", ""});
  }
  join_parts(parts, options);
  std::vector<ConvexPart> result;
  for (Points& part : parts) result.push_back({std::move(part)});
  return result;
}

}  // namespace rubble
