#include "kernel/geometry/lattice_hull.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <functional>
#include <queue>
#include <stdexcept>
#include <utility>

namespace rubble {
namespace {

GridPoint operator-(const GridPoint& a, const GridPoint& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
GridPoint cross(const GridPoint& a, const GridPoint& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
std::int64_t dot(const GridPoint& a, const GridPoint& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
bool is_zero(const GridPoint& a) { return a.x == 0 && a.y == 0 && a.z == 0; }

[[noreturn]] void fail_flat() { throw std::invalid_argument("the points do not span a volume"); }

// A face of the growing hull. Side i goes from corner i to the next.
struct Triangle {
  std::array<int, 3> corners;
  std::array<int, 3> neighbours;
  GridPoint normal;       // outwards
  int outside = -1;       // the first of the points that stand out of it
  int farthest = -1;      // of these
  std::int64_t height = 0;
  bool alive = true;
};

class QuickHull {
 public:
  explicit QuickHull(const std::vector<GridPoint>& points)
      : points_(points), next_(points.size(), -1), over_(points.size(), -1) {}

  const std::vector<Triangle>& run() {
    make_first();
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      if (triangles_[t].alive && triangles_[t].outside >= 0) add_point(int(t));
    return triangles_;
  }

 private:
  const GridPoint& at(int point) const { return points_[std::size_t(point)]; }
  Triangle& triangle(int t) { return triangles_[std::size_t(t)]; }

  std::int64_t height(const Triangle& t, int point) const { return dot(t.normal, at(point) - at(t.corners[0])); }

  int make(int a, int b, int c) {
    Triangle made{};
    made.corners = {a, b, c};
    made.neighbours = {-1, -1, -1};
    made.normal = cross(at(b) - at(a), at(c) - at(a));
    triangles_.push_back(made);
    return int(triangles_.size()) - 1;
  }

  // Four points that span a volume: the lowest, the highest, and the farthest from both and from the plane of the three.
  void make_first() {
    const int a = 0, b = int(points_.size()) - 1;
    int c = -1, d = -1;
    GridPoint normal{0, 0, 0};
    for (int p = 1; p < b; ++p) {
      const GridPoint n = cross(at(b) - at(a), at(p) - at(a));
      if (size(n) > size(normal)) normal = n, c = p;
    }
    if (c < 0) fail_flat();
    std::int64_t most = 0;
    for (int p = 1; p < b; ++p) {
      const std::int64_t height = std::abs(dot(normal, at(p) - at(a)));
      if (height > most) most = height, d = p;
    }
    if (d < 0) fail_flat();
    if (dot(normal, at(d) - at(a)) > 0) std::swap(c, d);  // d below the triangle of the others
    const int abc = make(a, b, c), adb = make(a, d, b), bdc = make(b, d, c), cda = make(c, d, a);
    triangle(abc).neighbours = {adb, bdc, cda};
    triangle(adb).neighbours = {cda, bdc, abc};
    triangle(bdc).neighbours = {adb, cda, abc};
    triangle(cda).neighbours = {bdc, adb, abc};
    for (int p = 0; p < int(points_.size()); ++p)
      if (p != a && p != b && p != c && p != d) hand_out(p, 0);
  }

  static std::int64_t size(const GridPoint& a) { return std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)}); }

  // Gives the point to the first triangle, from one on, that it stands out of.
  void hand_out(int point, std::size_t from) {
    for (std::size_t t = from; t < triangles_.size(); ++t) {
      Triangle& one = triangles_[t];
      const std::int64_t height = this->height(one, point);
      if (height <= 0) continue;
      next_[std::size_t(point)] = one.outside;
      one.outside = point;
      if (height > one.height) one.height = height, one.farthest = point;
      return;
    }
  }

  // Replaces the triangles that see the farthest point of one of them by triangles with it as their corner. Those in
  // the plane of the point do not see it: their side at the rim is no line with it.
  void add_point(int first) {
    const int point = triangle(first).farthest;
    seen_.assign(1, first), rim_.clear();
    triangle(first).alive = false;
    for (std::size_t i = 0; i < seen_.size(); ++i)
      for (int side = 0; side < 3; ++side) {
        const Triangle& from = triangle(seen_[i]);
        const int other = from.neighbours[std::size_t(side)];
        if (!triangle(other).alive) continue;
        if (height(triangle(other), point) > 0) {
          triangle(other).alive = false;
          seen_.push_back(other);
        } else {
          rim_.push_back({from.corners[std::size_t(side)], from.corners[std::size_t((side + 1) % 3)], other});
        }
      }
    const std::size_t begin = triangles_.size();
    for (const Rim& rim : rim_) {
      const int made = make(rim.from, rim.to, point);
      over_[std::size_t(rim.from)] = made;
      triangle(made).neighbours[0] = rim.beyond;
      Triangle& beyond = triangle(rim.beyond);
      for (std::size_t side = 0; side < 3; ++side)
        if (beyond.corners[side] == rim.to && beyond.corners[(side + 1) % 3] == rim.from) beyond.neighbours[side] = made;
    }
    for (std::size_t t = begin; t < triangles_.size(); ++t) {
      const int after = over_[std::size_t(triangles_[t].corners[1])];
      triangles_[t].neighbours[1] = after;
      triangle(after).neighbours[2] = int(t);
    }
    for (const int t : seen_)
      for (int p = triangle(t).outside; p >= 0;) {
        const int following = next_[std::size_t(p)];
        if (p != point) hand_out(p, begin);
        p = following;
      }
  }

  struct Rim {
    int from, to, beyond;  // side of a triangle that sees the point; the triangle beyond it, which does not
  };

  const std::vector<GridPoint>& points_;
  std::vector<Triangle> triangles_;
  std::vector<int> next_;  // of each point: another that stands out of the same triangle
  std::vector<int> over_;  // of each point: the new triangle whose first corner it is
  std::vector<int> seen_;
  std::vector<Rim> rim_;
};

// Triangles in one plane as one polygon, in the order that calc_lattice_hull() promises.
class Faces {
 public:
  Faces(const std::vector<GridPoint>& points, const std::vector<Triangle>& triangles)
      : points_(points), triangles_(triangles), face_of_(triangles.size(), -1), next_(points.size(), -1) {
    for (std::size_t t = 0; t < triangles.size(); ++t)
      if (triangles[t].alive && face_of_[t] < 0) add_face(int(t));
    face_over_ = FaceOfEdge(faces_);
  }

  std::vector<Polygon> in_order() {
    std::vector<Polygon> ordered;
    std::vector<char> taken(faces_.size(), 0);
    std::priority_queue<std::uint64_t, std::vector<std::uint64_t>, std::greater<std::uint64_t>> open;
    const auto take = [&](int f) {
      Polygon& face = faces_[std::size_t(f)];
      if (taken[std::size_t(f)]) return;
      taken[std::size_t(f)] = 1;
      for (std::size_t i = 0; i < face.size(); ++i) open.push(FaceOfEdge::key(face[(i + 1) % face.size()], face[i]));
      ordered.push_back(std::move(face));
    };
    take(find_first());
    while (!open.empty()) {
      const std::uint64_t edge = open.top();
      open.pop();
      take(face_over_.find(edge));
    }
    return ordered;
  }

 private:
  const GridPoint& at(int point) const { return points_[std::size_t(point)]; }
  bool lies_in_plane(const Triangle& t, int point) const { return dot(t.normal, at(point) - at(t.corners[0])) == 0; }

  void add_face(int first) {
    const Triangle& seed = triangles_[std::size_t(first)];
    const int face = int(faces_.size());
    std::vector<int> group{first};
    std::vector<std::pair<int, int>> rim;
    face_of_[std::size_t(first)] = face;
    for (std::size_t g = 0; g < group.size(); ++g) {
      const Triangle& t = triangles_[std::size_t(group[g])];
      for (std::size_t side = 0; side < 3; ++side) {
        const int other = t.neighbours[side];
        const Triangle& beyond = triangles_[std::size_t(other)];
        const bool flat = std::all_of(beyond.corners.begin(), beyond.corners.end(),
                                      [&](int corner) { return lies_in_plane(seed, corner); });
        if (!flat)
          rim.emplace_back(t.corners[side], t.corners[(side + 1) % 3]);
        else if (face_of_[std::size_t(other)] < 0)
          face_of_[std::size_t(other)] = face, group.push_back(other);
      }
    }
    for (const auto& [a, b] : rim) next_[std::size_t(a)] = b;
    Polygon around;
    for (int corner = rim[0].first; around.empty() || corner != around[0]; corner = next_[std::size_t(corner)]) {
      around.push_back(corner);
      if (around.size() > rim.size()) throw std::logic_error("hull: an outline does not close");
    }
    Polygon strict;
    for (std::size_t i = 0; i < around.size(); ++i) {
      const int before = around[(i + around.size() - 1) % around.size()], after = around[(i + 1) % around.size()];
      if (!is_zero(cross(at(around[i]) - at(before), at(after) - at(around[i])))) strict.push_back(around[i]);
    }
    std::rotate(strict.begin(), std::min_element(strict.begin(), strict.end()), strict.end());
    faces_.push_back(std::move(strict));
  }

  // Over the edge at the lowest point of the outline in (x, y), in the vertical plane through it, where that holds a face.
  int find_first() const {
    GridPoint n{0, 0, 0};
    for (const GridPoint& p : points_) {
      const GridPoint d = p - points_[0];
      if (is_zero(n) ? (d.x != 0 || d.y != 0) : dot(n, d) > 0) n = {d.y, -d.x, 0};
    }
    int low = -1, high = -1;
    for (int p = 0; p < int(points_.size()); ++p)
      if (dot(n, at(p) - points_[0]) == 0) low = low < 0 ? p : low, high = p;
    for (std::size_t f = 0; f < faces_.size(); ++f)
      if (std::all_of(faces_[f].begin(), faces_[f].end(), [&](int p) { return dot(n, at(p) - points_[0]) == 0; })) return int(f);
    return face_over_.find(FaceOfEdge::key(low, high));
  }

  const std::vector<GridPoint>& points_;
  const std::vector<Triangle>& triangles_;
  std::vector<int> face_of_;  // of each triangle
  std::vector<int> next_;     // along an outline
  std::vector<Polygon> faces_;
  FaceOfEdge face_over_{{}};
};

}  // namespace

FaceOfEdge::FaceOfEdge(const std::vector<Polygon>& faces) {
  for (std::size_t f = 0; f < faces.size(); ++f)
    for (std::size_t i = 0; i < faces[f].size(); ++i)
      edges_.emplace_back(key(faces[f][i], faces[f][(i + 1) % faces[f].size()]), int(f));
  std::sort(edges_.begin(), edges_.end());
}

int FaceOfEdge::find(std::uint64_t edge) const {
  const auto found = std::lower_bound(edges_.begin(), edges_.end(), std::make_pair(edge, 0));
  if (found == edges_.end() || found->first != edge) throw std::logic_error("hull: an edge has one face");
  return found->second;
}

LatticePoints round_to_lattice(const std::vector<Vec3>& points) {
  LatticePoints rounded;
  Aabb box;
  for (const Vec3& p : points) box.include(p);
  const Vec3 extent = box.max - box.min;
  rounded.longest = std::max(extent.x, std::max(extent.y, extent.z));
  if (points.size() < 4 || !(rounded.longest > 0)) fail_flat();
  std::vector<std::pair<GridPoint, int>> placed;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 g = (points[i] - box.min) * (kLatticeSteps / rounded.longest);
    placed.push_back({{std::int64_t(g.x + 0.5), std::int64_t(g.y + 0.5), std::int64_t(g.z + 0.5)}, int(i)});
  }
  std::sort(placed.begin(), placed.end());
  for (const auto& [point, index] : placed) {
    if (!rounded.grid.empty() && rounded.grid.back() == point) continue;
    rounded.grid.push_back(point), rounded.source.push_back(index);
  }
  return rounded;
}

std::vector<Polygon> calc_lattice_hull(const std::vector<GridPoint>& points) {
  if (points.size() < 4) fail_flat();
  QuickHull hull(points);
  return Faces(points, hull.run()).in_order();
}

}  // namespace rubble
