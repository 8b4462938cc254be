#include "kernel/geometry/decomposing/decompose_steps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <stdexcept>
#include <tuple>

#include "kernel/geometry/hull.h"

namespace rubble::decomposing {
namespace {

using Points = std::vector<Vec3>;

constexpr std::size_t kMeasuredCuts = 6;      // that look best by coarse hulls and are measured by fine ones
constexpr double kLittleGain = 0.25;          // of the volume outside: who saves less is judged by the next cuts too
constexpr double kBalance = 0.02;             // of the hulls, that an uneven cut must save besides
constexpr double kNarrow = 1e-3;              // of the solid's size: nothing is cut off that is narrower
constexpr double kConcaveCosine = 0.9986;     // 3 degrees: flatter edges count as smooth
constexpr std::size_t kCoarse = 26, kFine = 98;  // directions by which hulls are known

// The primitive integer vectors of [-2, 2]^3, those of [-1, 1]^3 first.
const std::array<Vec3, kFine>& directions() {
  static const std::array<Vec3, kFine> all = [] {
    std::array<Vec3, kFine> list{};
    std::size_t coarse = 0, fine = kCoarse;
    for (int x = -2; x <= 2; ++x)
      for (int y = -2; y <= 2; ++y)
        for (int z = -2; z <= 2; ++z) {
          if (x % 2 == 0 && y % 2 == 0 && z % 2 == 0) continue;
          const bool small = std::max({std::abs(x), std::abs(y), std::abs(z)}) == 1;
          list[small ? coarse++ : fine++] = Vec3(x, y, z);
        }
    return list;
  }();
  return all;
}

// Half of them, and the place of each and of its opposite in the list.
struct Axes {
  std::array<double, kFine / 2> x{}, y{}, z{};
  std::array<std::size_t, kFine / 2> along{}, against{};
};
const Axes& axes() {
  static const Axes all = [] {
    Axes list;
    std::size_t n = 0;
    for (std::size_t d = 0; d < kFine; ++d)
      for (std::size_t e = d + 1; e < kFine; ++e)
        if (directions()[e] == -directions()[d]) {
          const Vec3& v = directions()[d];
          list.x[n] = v.x, list.y[n] = v.y, list.z[n] = v.z, list.along[n] = d, list.against[n] = e;
          ++n;
        }
    return list;
  }();
  return all;
}

// How many planes across an axis are tried.
struct Choice {
  int even;             // that cut the box into so many equal slabs
  std::size_t concave;  // through concave edges, at most
};
constexpr Choice kCut{12, 12}, kNextCut{6, 3};

// Of a set of points the farthest along each direction.
struct Extremes {
  std::array<double, kFine> heights{};
  Points points;  // by direction; empty: of no points

  void keep(std::size_t direction, double height, const Vec3& p) {
    if (height > heights[direction]) heights[direction] = height, points[direction] = p;
  }
  void add(const Vec3& p) {
    if (points.empty()) points.assign(kFine, p), heights.fill(-1e300);
    const Axes& half = axes();
    std::array<double, kFine / 2> along;
    for (std::size_t a = 0; a < kFine / 2; ++a) along[a] = half.x[a] * p.x + half.y[a] * p.y + half.z[a] * p.z;
    for (std::size_t a = 0; a < kFine / 2; ++a) {
      keep(half.along[a], along[a], p);
      keep(half.against[a], -along[a], p);
    }
  }
  void add(const Extremes& other) {
    if (other.points.empty()) return;
    if (points.empty()) {
      *this = other;
      return;
    }
    for (std::size_t d = 0; d < kFine; ++d)
      if (other.heights[d] > heights[d]) heights[d] = other.heights[d], points[d] = other.points[d];
  }
};

// Extremes of many points, most of which come several times: triangles share their corners.
class ExtremesOfSurface {
 public:
  explicit ExtremesOfSurface(Extremes& extremes) : extremes_(extremes) {}

  void add(const Vec3& p) {
    std::array<std::uint64_t, 3> bits;
    std::memcpy(bits.data(), &p.x, sizeof p.x), std::memcpy(&bits[1], &p.y, sizeof p.y), std::memcpy(&bits[2], &p.z, sizeof p.z);
    const std::uint64_t mixed = (bits[0] * 3 + bits[1] * 5 + bits[2] * 7) * 0x9e3779b97f4a7c15u;
    Vec3& last = last_[mixed >> (64 - kBits)];
    if (is_first_ || !(last == p)) extremes_.add(p), last = p;
    if (is_first_) last_.fill(p), is_first_ = false;
  }

 private:
  static constexpr int kBits = 8;
  Extremes& extremes_;
  std::array<Vec3, 1 << kBits> last_;  // that were added, by the bits of their numbers
  bool is_first_ = true;
};

// Convex polygons of the surface, one after the other.
struct Surface {
  Points points;
  std::vector<std::uint32_t> ends;  // one past the last point of each

  void add(const Points& polygon) {
    if (polygon.size() < 3) return;
    points.insert(points.end(), polygon.begin(), polygon.end());
    ends.push_back(std::uint32_t(points.size()));
  }
};

// Divides the surface by a plane across an axis; what lies in the plane goes to both sides.
void split(const Surface& surface, int axis, double at, Surface& below, Surface& above) {
  Points low, high;
  std::uint32_t begin = 0;
  for (const std::uint32_t end : surface.ends) {
    low.clear(), high.clear();
    for (std::uint32_t i = begin; i < end; ++i) {
      const Vec3 &a = surface.points[i], &b = surface.points[i + 1 < end ? i + 1 : begin];
      const double ha = a[axis] - at, hb = b[axis] - at;
      if (ha <= 0) low.push_back(a);
      if (ha >= 0) high.push_back(a);
      if ((ha < 0 && hb > 0) || (ha > 0 && hb < 0)) {
        // In one order of the ends, so that neighbours get the same point.
        const bool ordered = ha < hb;
        const Vec3 &u = ordered ? a : b, &v = ordered ? b : a;
        const double hu = ordered ? ha : hb, hv = ordered ? hb : ha;
        Vec3 p = u + (v - u) * (hu / (hu - hv));
        p[axis] = at;
        low.push_back(p), high.push_back(p);
      }
    }
    below.add(low), above.add(high);
    begin = end;
  }
}

struct Leaf {
  Aabb box;
  Surface surface;
  Extremes extremes;
  Misfit misfit;
  bool final = false;  // it cannot be cut any more
};

void add_corners(const Solid& solid, const Aabb& box, bool exact, const std::function<void(const Vec3&)>& visit) {
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner{i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y, i & 4 ? box.max.z : box.min.z};
    if (exact ? solid.contains(corner) : solid.is_deep_inside(corner)) visit(corner);
  }
}

// What is outside the solid of two hulls, known by so many directions, and what they are uneven. unit: m3
struct CutCost {
  double outside = 0, uneven = 0;
  double sum() const { return outside + kBalance * uneven; }
};

struct HullMisfit {
  double volume = 0;  // of the hull; unit: m3
  Misfit misfit;
};

// By volumes alone hulls of rounded halves would seem larger than that of the whole, as directions are few.
HullMisfit measure(const Solid& solid, const Extremes& extremes, std::size_t directions) {
  try {
    const Hull hull = calc_hull(Points(extremes.points.begin(), extremes.points.begin() + std::ptrdiff_t(directions)));
    return {calc_volume(hull), solid.measure(hull)};
  } catch (const std::invalid_argument&) {
    return {};  // flat
  }
}

CutCost calc_cost(const Solid& solid, const Extremes& below, const Extremes& above, std::size_t directions) {
  const HullMisfit a = measure(solid, below, directions), b = measure(solid, above, directions);
  return {a.misfit.outside + b.misfit.outside, std::fabs(a.volume - b.volume)};
}

// The edges at which the solid is concave and that lie in planes across an axis.
struct ConcaveEdge {
  Aabb box;
  double length;
};

std::vector<ConcaveEdge> find_concave_edges(const TriangleMesh& mesh) {
  std::map<std::tuple<float, float, float>, int> known;
  std::vector<int> welded;
  Points places;
  for (const Vec3f& p : mesh.positions) {
    const auto [at, is_new] = known.try_emplace({p.x, p.y, p.z}, int(places.size()));
    if (is_new) places.emplace_back(p);
    welded.push_back(at->second);
  }
  std::map<std::pair<int, int>, std::pair<Vec3, int>> sides;  // of each directed edge: the normal, the third corner
  for (const auto& t : mesh.triangles) {
    const int w[3] = {welded[t[0]], welded[t[1]], welded[t[2]]};
    const Vec3 normal = normalized(cross(places[std::size_t(w[1])] - places[std::size_t(w[0])],
                                         places[std::size_t(w[2])] - places[std::size_t(w[0])]));
    for (int k = 0; k < 3; ++k) sides[{w[k], w[(k + 1) % 3]}] = {normal, w[(k + 2) % 3]};
  }
  std::vector<ConcaveEdge> edges;
  for (const auto& [edge, side] : sides) {
    if (edge.first > edge.second) continue;
    const auto other = sides.find({edge.second, edge.first});
    if (other == sides.end() || dot(side.first, other->second.first) > kConcaveCosine) continue;
    const Vec3 &a = places[std::size_t(edge.first)], &b = places[std::size_t(edge.second)];
    if (dot(side.first, places[std::size_t(other->second.second)] - a) <= 0) continue;
    ConcaveEdge concave{{}, distance(a, b)};
    concave.box.include(a), concave.box.include(b);
    edges.push_back(concave);
  }
  return edges;
}

class Cutter {
 public:
  Cutter(const TriangleMesh& mesh, const Solid& solid, const CutLimits& limits)
      : solid_(solid), limits_(limits), concave_(find_concave_edges(mesh)) {
    const Vec3 extent = mesh.bounds().max - mesh.bounds().min;
    narrow_ = kNarrow * std::max({extent.x, extent.y, extent.z});
    Leaf whole;
    whole.box = mesh.bounds();
    for (const auto& t : mesh.triangles)
      whole.surface.add({Vec3(mesh.positions[t[0]]), Vec3(mesh.positions[t[1]]), Vec3(mesh.positions[t[2]])});
    for (const Vec3f& p : mesh.positions) whole.extremes.add(Vec3(p));
    whole.misfit = measure(solid, whole.extremes, kFine).misfit;
    leaves_.push_back(std::move(whole));
  }

  std::vector<Piece> run() {
    while (leaves_.size() < limits_.most) {
      const std::size_t worst = find_worst();
      if (worst == leaves_.size()) break;
      Leaf below, above;
      if (!find_cut(leaves_[worst], below, above)) {
        leaves_[worst].final = true;
        continue;
      }
      leaves_[worst] = std::move(below);
      leaves_.insert(leaves_.begin() + std::ptrdiff_t(worst) + 1, std::move(above));
    }
    std::vector<Piece> pieces;
    for (const Leaf& leaf : leaves_) {
      Piece piece{leaf.surface.points, leaf.misfit};
      add_corners(solid_, leaf.box, true, [&](const Vec3& corner) { piece.points.push_back(corner); });
      if (piece.points.size() >= 4) pieces.push_back(std::move(piece));
    }
    return pieces;
  }

 private:
  // That with most volume outside the solid; where all have little, that which stands out farthest.
  std::size_t find_worst() const {
    double total = 0;
    for (const Leaf& leaf : leaves_) total += leaf.misfit.outside;
    const bool by_volume = total > limits_.volume;
    std::size_t worst = leaves_.size();
    double most = by_volume ? 0 : limits_.gap;
    for (std::size_t i = 0; i < leaves_.size(); ++i) {
      const double misfit = by_volume ? leaves_[i].misfit.outside : leaves_[i].misfit.gap;
      if (!leaves_[i].final && misfit > most) most = misfit, worst = i;
    }
    return worst;
  }

  // Places of planes across an axis, ascending.
  std::vector<double> find_planes(const Aabb& box, int axis, const Choice& choice) const {
    const double low = box.min[axis] + narrow_, high = box.max[axis] - narrow_;
    std::map<double, double> weights;
    for (const ConcaveEdge& edge : concave_) {
      const double at = 0.5 * (edge.box.min[axis] + edge.box.max[axis]);
      if (edge.box.max[axis] - edge.box.min[axis] > 0.1 * narrow_ || at < low || at > high) continue;
      bool meets = true;
      for (int k = 0; k < 3; ++k) meets = meets && edge.box.min[k] <= box.max[k] && edge.box.max[k] >= box.min[k];
      if (meets) weights[at] += edge.length;
    }
    std::vector<std::pair<double, double>> concave;  // weight, place
    for (const auto& [at, weight] : weights) concave.emplace_back(-weight, at);
    std::stable_sort(concave.begin(), concave.end());
    std::vector<double> planes;
    const auto add = [&](double at, double apart) {
      for (const double other : planes)
        if (std::fabs(at - other) < apart) return;
      planes.push_back(at);
    };
    for (const auto& [weight, at] : concave)
      if (planes.size() < choice.concave) add(at, 0.1 * narrow_);
    for (int i = 1; i < choice.even; ++i) {
      const double at = box.min[axis] + (box.max[axis] - box.min[axis]) * i / choice.even;
      if (at > low && at < high) add(at, narrow_);
    }
    std::sort(planes.begin(), planes.end());
    return planes;
  }

  struct Cut {
    int axis;
    double at, cost;
    Extremes below, above;
  };

  // Cuts across an axis with their cost by coarse hulls. The surface is divided once, by all planes.
  void add_cuts(const Leaf& leaf, int axis, const Choice& choice, std::vector<Cut>& cuts) const {
    const std::vector<double> planes = find_planes(leaf.box, axis, choice);
    if (planes.empty()) return;
    std::vector<Extremes> slabs(planes.size() + 1);
    Surface rest = leaf.surface;
    for (std::size_t i = 0; i <= planes.size(); ++i) {
      Surface slab, above;
      if (i < planes.size())
        split(rest, axis, planes[i], slab, above);
      else
        slab = std::move(rest);
      ExtremesOfSurface extremes(slabs[i]);
      for (const Vec3& p : slab.points) extremes.add(p);
      rest = std::move(above);
    }
    std::vector<Extremes> above(slabs.size());
    for (std::size_t i = slabs.size(); i-- > 1;) {
      if (i + 1 < slabs.size()) above[i] = above[i + 1];
      above[i].add(slabs[i]);
    }
    Extremes below;
    for (std::size_t i = 0; i < planes.size(); ++i) {
      below.add(slabs[i]);
      Cut cut{axis, planes[i], 0, below, above[i + 1]};
      Aabb low = leaf.box, high = leaf.box;
      low.max[axis] = high.min[axis] = planes[i];
      add_corners(solid_, low, false, [&](const Vec3& corner) { cut.below.add(corner); });
      add_corners(solid_, high, false, [&](const Vec3& corner) { cut.above.add(corner); });
      if (cut.below.points.empty() || cut.above.points.empty()) continue;
      cut.cost = calc_cost(solid_, cut.below, cut.above, kCoarse).sum();
      cuts.push_back(std::move(cut));
    }
  }

  static bool is_cheaper(const Cut& a, const Cut& b) { return a.cost < b.cost; }

  bool find_cut(const Leaf& leaf, Leaf& below, Leaf& above) const {
    std::vector<Cut> cuts;
    for (int axis = 0; axis < 3; ++axis) add_cuts(leaf, axis, kCut, cuts);
    if (cuts.empty()) return false;
    std::stable_sort(cuts.begin(), cuts.end(), is_cheaper);
    const Cut* best = nullptr;
    double least = 1e300, saved = 0;
    for (std::size_t i = 0; i < std::min(cuts.size(), kMeasuredCuts); ++i) {
      const CutCost cost = calc_cost(solid_, cuts[i].below, cuts[i].above, kFine);
      if (cost.sum() < least) least = cost.sum(), saved = leaf.misfit.outside - cost.outside, best = &cuts[i];
    }
    // The halves of a ring are as large as the ring, whichever way it is cut: what counts is what they are cut into.
    if (saved < kLittleGain * leaf.misfit.outside) {
      const Cut* one = find_cut_for_next(leaf, cuts);
      if (one) best = one;
    }
    divide(leaf, *best, below, above);
    below.misfit = measure(solid_, below.extremes, kFine).misfit, above.misfit = measure(solid_, above.extremes, kFine).misfit;
    return true;
  }

  // Of the cheapest cut across each axis that whose halves are cut at least cost.
  const Cut* find_cut_for_next(const Leaf& leaf, const std::vector<Cut>& cuts) const {
    const Cut* best = nullptr;
    double least = 1e300;
    for (int axis = 0; axis < 3; ++axis) {
      const auto cheapest = std::find_if(cuts.begin(), cuts.end(), [axis](const Cut& cut) { return cut.axis == axis; });
      if (cheapest == cuts.end()) continue;
      Leaf halves[2];
      divide(leaf, *cheapest, halves[0], halves[1]);
      double cost = 0;
      for (const Leaf& half : halves) {
        std::vector<Cut> next;
        for (int k = 0; k < 3; ++k) add_cuts(half, k, kNextCut, next);
        const auto cut = std::min_element(next.begin(), next.end(), is_cheaper);
        cost += cut == next.end() ? measure(solid_, half.extremes, kCoarse).misfit.outside : cut->cost;
      }
      if (cost < least) least = cost, best = &*cheapest;
    }
    return best;
  }

  void divide(const Leaf& leaf, const Cut& cut, Leaf& below, Leaf& above) const {
    split(leaf.surface, cut.axis, cut.at, below.surface, above.surface);
    below.extremes = cut.below, above.extremes = cut.above;
    below.box = above.box = leaf.box;
    below.box.max[cut.axis] = above.box.min[cut.axis] = cut.at;
    if (!solid_.is_exact()) return;
    for (Leaf* half : {&below, &above}) {
      add_corners(solid_, half->box, true, [half](const Vec3& corner) { half->extremes.add(corner); });
      Aabb tight;
      for (const Vec3& p : half->extremes.points) tight.include(p);
      half->box = {max(half->box.min, tight.min), min(half->box.max, tight.max)};
    }
  }

  const Solid& solid_;
  CutLimits limits_;
  std::vector<ConcaveEdge> concave_;
  double narrow_ = 0;
  std::vector<Leaf> leaves_;
};

}  // namespace

std::vector<Piece> cut_into_boxes(const TriangleMesh& mesh, const Solid& solid, const CutLimits& limits) {
  return Cutter(mesh, solid, limits).run();
}

}  // namespace rubble::decomposing
