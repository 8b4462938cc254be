#include "kernel/geometry/decompose.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "kernel/base/error.h"
#include "kernel/geometry/decomposing/decompose_steps.h"
#include "kernel/geometry/decomposing/solid.h"
#include "kernel/geometry/hull.h"
#include "kernel/geometry/simplify_hull.h"

namespace rubble {
namespace {

using Points = std::vector<Vec3>;

constexpr double kLeastGap = 0.006;        // that counts as one; unit: m
constexpr double kCheapJoin = 0.1;         // of the tolerance, that a join below the wanted number may cost
constexpr std::size_t kBoxesPerPart = 3;   // cut for each of max_parts at most: joining mends cuts that went too far
constexpr std::size_t kLeastBoxes = 24, kMostBoxes = 112;
constexpr double kCornerTolerance = 5e-4;  // unit: m; corners that stand out by less are no gain
constexpr double kCornerShare = 1e-3;      // likewise, of the size of a part
constexpr std::size_t kManyPoints = 1500;  // of a part, from which on its hull is a simplified one
constexpr std::size_t kJoinCorners = 300;  // of such a hull
constexpr double kFrameCosine = 0.9998;    // between faces that count as parallel: 1 degree
constexpr double kFrameShare = 0.08;       // of the surface, that the faces of a frame have at least
constexpr std::size_t kFrameFaces = 48;    // the largest, that are tried as the first direction of a frame

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

// Widened across its thinnest direction to what collision needs.
Points widened(Points points, double thinnest) {
  double least = 1e300, middle = 0;
  Vec3 across;
  for (const HullPlane& plane : calc_planes(calc_hull(points))) {
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

double calc_size(const Points& points) {
  Aabb box;
  for (const Vec3& p : points) box.include(p);
  const Vec3 extent = box.max - box.min;
  return std::max({extent.x, extent.y, extent.z});
}

// None: flat. What is nearly flat may be so on the lattice of one hull and not on that of its corners, or in another frame.
std::optional<Hull> hull_or_none(const Points& points) {
  try {
    return calc_hull(points);
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

// The corners of the hull, or nearly; empty: flat.
Points hull_corners(const Points& points) {
  try {
    if (points.size() <= kManyPoints) return calc_hull(points).points;
    return simplify_hull(points, kJoinCorners, 0.1 * kCornerShare * calc_size(points)).points;
  } catch (const std::invalid_argument&) {
    return {};
  }
}

// Empty: the points lie in a line. What is thinner than the hull's lattice or the tolerance of corners tells is flat as well.
Points make_part(const Points& points, const DecomposeOptions& options) {
  for (const bool flat : {calc_hull_volume(points) <= 0, true}) {
    try {
      const Points solid = flat ? thickened(points, options.thinnest) : points;
      const double tolerance = std::max(kCornerTolerance, kCornerShare * calc_size(solid));
      return widened(restore_volume(simplify_hull(solid, std::size_t(options.max_corners), tolerance), solid),
                     options.thinnest);
    } catch (const std::invalid_argument&) {
    }
  }
  return {};
}

// What parts may do at most.
struct Limits {
  double cheap = 0, outside = 0, most_outside = 0;  // unit: m3
  double gap = 0;                                   // unit: m
};

// Joins the pair whose common hull has least more volume outside the solid, again and again.
class Joiner {
 public:
  Joiner(const Solid& solid, std::vector<decomposing::Piece> pieces, const Limits& limits)
      : solid_(solid), limits_(limits) {
    for (decomposing::Piece& piece : pieces) {
      Part part;
      part.points = hull_corners(piece.points);
      if (part.points.empty()) {  // flat
        part.points = std::move(piece.points);
      } else {
        if (const std::optional<Hull> hull = hull_or_none(part.points)) part.misfit = solid.measure(*hull);
      }
      for (const Vec3& p : part.points) part.box.include(p);
      outside_ += part.misfit.outside;
      parts_.push_back(std::move(part));
    }
    left_ = parts_.size();
    joins_.resize(left_ * left_);
    for (std::size_t i = 0; i < left_; ++i)
      for (std::size_t j = i + 1; j < left_; ++j) try_join(i, j);
  }

  // until: the parts that are wanted, and those that there may be at most.
  std::vector<Points> run(std::size_t wanted, std::size_t most) {
    while (left_ > 1) {
      const std::size_t best = find_join(left_ > most, left_ > wanted);
      if (best == joins_.size()) break;
      join(best / parts_.size(), best % parts_.size());
    }
    std::vector<Points> result;
    for (Part& part : parts_)
      if (!part.joined) result.push_back(std::move(part.points));
    return result;
  }

 private:
  struct Part {
    Points points;
    Aabb box;
    Misfit misfit;
    bool joined = false;  // to another
  };
  struct Join {
    double growth = 1e300;  // of the volume outside the solid; unit: m3
    double gap = 0;
  };

  static bool touch(const Aabb& a, const Aabb& b, double margin) {
    for (int k = 0; k < 3; ++k)
      if (a.min[k] > b.max[k] + margin || b.min[k] > a.max[k] + margin) return false;
    return true;
  }

  Points both(std::size_t i, std::size_t j) const {
    Points points = parts_[i].points;
    points.insert(points.end(), parts_[j].points.begin(), parts_[j].points.end());
    return points;
  }

  void try_join(std::size_t i, std::size_t j) {
    Join& join = joins_[i * parts_.size() + j];
    join = {};
    if (!touch(parts_[i].box, parts_[j].box, solid_.cell())) return;
    try {
      const Misfit common = solid_.measure(calc_hull(both(i, j)));
      join.growth = common.outside - parts_[i].misfit.outside - parts_[j].misfit.outside;
      join.gap = common.gap;
    } catch (const std::invalid_argument&) {
      join.growth = 0;  // both lie in one plane
    }
  }

  // The cheapest that keeps to the limits; `forced`: that does most nearly. joins_.size(): none.
  std::size_t find_join(bool forced, bool many) const {
    std::size_t best = joins_.size();
    double least = 1e299;
    for (std::size_t n = 0; n < joins_.size(); ++n) {
      const Join& join = joins_[n];
      if (join.growth > 1e299) continue;
      const double outside = outside_ + join.growth;
      const bool fits = join.gap <= limits_.gap && outside <= (many ? limits_.most_outside : limits_.outside) &&
                        (many || join.growth <= limits_.cheap);
      if (!fits && !forced) continue;
      // A gap too large costs as much as all volume that parts may have outside, each time.
      const double cost = join.growth + limits_.most_outside * std::max(0.0, join.gap / limits_.gap - 1);
      if (cost < least) least = cost, best = n;
    }
    return best;
  }

  void join(std::size_t i, std::size_t j) {
    const Join done = joins_[i * parts_.size() + j];
    Part& part = parts_[i];
    Points points = both(i, j), corners = hull_corners(points);
    part.points = corners.empty() ? std::move(points) : std::move(corners);
    part.misfit.outside += parts_[j].misfit.outside + done.growth;
    part.misfit.gap = done.gap;
    for (const Vec3& p : part.points) part.box.include(p);
    outside_ += done.growth;
    parts_[j].joined = true, parts_[j].points.clear();
    --left_;
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      joins_[std::min(j, k) * parts_.size() + std::max(j, k)] = {};
      if (k != i && !parts_[k].joined) try_join(std::min(i, k), std::max(i, k));
    }
  }

  const Solid& solid_;
  Limits limits_;
  std::vector<Part> parts_;
  std::vector<Join> joins_;  // of parts i < j: at i * parts + j
  double outside_ = 0;
  std::size_t left_ = 0;
};

// The directions across which most of the surface lies, where that is much; else the mesh's own axes. Pipes, profiles
// and boxes are then cut as well in any pose.
Mat3 find_frame(const TriangleMesh& mesh) {
  std::vector<Vec3> areas;
  double total = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 a(mesh.positions[t[0]]);
    areas.push_back(cross(Vec3(mesh.positions[t[1]]) - a, Vec3(mesh.positions[t[2]]) - a));
    total += norm(areas.back());
  }
  std::vector<std::size_t> order(areas.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return norm(areas[a]) > norm(areas[b]); });
  const auto across = [&](const Vec3& direction) {
    double sum = 0;
    for (const Vec3& area : areas)
      if (std::fabs(dot(area, direction)) > kFrameCosine * norm(area)) sum += norm(area);
    return sum;
  };
  const auto widest = [&](const auto& fits, double& share) {
    Vec3 best;
    std::size_t tried = 0;
    share = 0;
    for (const std::size_t i : order) {
      if (!fits(areas[i])) continue;
      const Vec3 direction = normalized(areas[i]);
      if (const double sum = across(direction); sum > 1.0001 * share) share = sum, best = direction;
      if (++tried == kFrameFaces) break;
    }
    return best;
  };
  double first_share = 0, second_share = 0, own = 0;
  const Vec3 first = widest([](const Vec3&) { return true; }, first_share);
  const Vec3 second = widest([&](const Vec3& area) { return std::fabs(dot(area, first)) < 1e-3 * norm(area); }, second_share);
  for (const Vec3& axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) own += across(axis);
  if (norm(second) < 0.5 || first_share + second_share < std::max(kFrameShare * total, 1.01 * own)) return Mat3::identity();
  const Vec3 third = normalized(cross(first, second));
  return {{first, cross(third, first), third}};
}

TriangleMesh turn(const TriangleMesh& mesh, const Mat3& rotation) {
  TriangleMesh turned;
  turned.triangles = mesh.triangles;
  for (const Vec3f& p : mesh.positions) turned.positions.push_back(Vec3f(rotation * Vec3(p)));
  return turned;
}

// The frame with its axes renamed, so that the mesh is longest along z.
Mat3 with_longest_last(const Mat3& frame, const TriangleMesh& mesh) {
  const Aabb box = turn(mesh, frame).bounds();
  const Vec3 extent = box.max - box.min;
  if (extent.z >= extent.x && extent.z >= extent.y) return frame;
  if (extent.x >= extent.y) return {{frame.rows[1], frame.rows[2], frame.rows[0]}};
  return {{frame.rows[2], frame.rows[0], frame.rows[1]}};
}

[[noreturn]] void fail_without_volume() {
  throw InputError({"", 0, "", "the mesh cannot be cut into convex parts", "a mesh with a volume",
                    "points in one line or one place", ""});
}

// Parts in the frame of the mesh.
std::vector<Points> find_parts(const TriangleMesh& mesh, const Solid& solid, const DecomposeOptions& options) {
  const Vec3 extent = mesh.bounds().max - mesh.bounds().min;
  Limits limits;
  limits.outside = options.tolerance * solid.volume();
  limits.cheap = kCheapJoin * limits.outside;
  limits.most_outside = std::max(options.tolerance, options.most_outside) * solid.volume();
  limits.gap = std::max(kLeastGap, options.most_gap * std::min(std::max({extent.x, extent.y, extent.z}),
                                                               4 * std::min({extent.x, extent.y, extent.z})));
  const std::size_t wanted = std::size_t(options.max_parts), most = std::size_t(std::max(options.max_parts, options.most_parts));
  decomposing::CutLimits cuts;
  cuts.most = std::clamp(kBoxesPerPart * most, kLeastBoxes, kMostBoxes);
  cuts.volume = 0.5 * limits.outside;
  cuts.gap = 0.5 * limits.gap;
  return Joiner(solid, decomposing::cut_into_boxes(mesh, solid, cuts), limits).run(wanted, most);
}

}  // namespace

Decomposition decompose(const TriangleMesh& mesh, const DecomposeOptions& options) {
  Decomposition result;
  for (Points& part : decomposing::find_exact_parts(mesh, options.max_parts, options.max_corners))
    result.parts.push_back({widened(std::move(part), options.thinnest)});
  if (!result.parts.empty()) {
    result.exact = true;
    result.volume = calc_volume_properties(mesh).volume;
    return result;
  }
  const Mat3 frame_from_mesh = with_longest_last(find_frame(mesh), mesh), mesh_from_frame = frame_from_mesh.transposed();
  const TriangleMesh turned = turn(mesh, frame_from_mesh);
  const Aabb box = turned.bounds();
  if (box.empty() || !(norm(box.max - box.min) > 0)) fail_without_volume();
  const Solid solid(turned, options.resolution);
  std::vector<Hull> hulls;
  for (Points& points : find_parts(turned, solid, options)) {
    for (Vec3& p : points) p = mesh_from_frame * p;
    Points part = make_part(points, options);  // which keeps its length, width and height
    if (part.empty()) continue;
    result.parts.push_back({part});
    for (Vec3& p : part) p = frame_from_mesh * p;
    if (const std::optional<Hull> hull = hull_or_none(part)) hulls.push_back(*hull);
  }
  if (result.parts.empty()) fail_without_volume();
  result.volume = solid.volume();
  result.misfit = solid.measure(hulls);
  return result;
}

}  // namespace rubble
