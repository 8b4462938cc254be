#include "kernel/geometry/triangle_mesh_shape.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace rubble {
namespace {

constexpr int kLeaf = 4;
// A neighbour counts as level when its far corner is this near to the plane; unit: m.
constexpr double kLevel = 1e-4;
// Of the length of an edge: what counts as equally far along a normal, and as behind a plane.
constexpr double kSameHeight = 1e-3;
constexpr double kBehind = 5e-3;

bool overlap(const Aabb& a, const Aabb& b) {
  return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y &&
         a.min.z <= b.max.z && b.min.z <= a.max.z;
}

}  // namespace

TriangleMeshShape::TriangleMeshShape(const TriangleMesh& mesh) {
  weld(mesh);
  if (triangles_.empty()) throw std::invalid_argument("a surface without any area");
  join();
  mark_sharp();
  order_.resize(triangles_.size());
  std::iota(order_.begin(), order_.end(), 0);
  build(0, int(order_.size()));
}

void TriangleMeshShape::weld(const TriangleMesh& mesh) {
  std::map<std::array<float, 3>, std::uint32_t> numbers;
  std::vector<std::uint32_t> number_of;
  for (const Vec3f& p : mesh.positions) {
    const auto [at, is_new] =
        numbers.insert({{p.x + 0.0F, p.y + 0.0F, p.z + 0.0F}, std::uint32_t(corners_.size())});
    if (is_new) corners_.push_back(Vec3(p));
    number_of.push_back(at->second);
  }
  for (const auto& corners : mesh.triangles) {
    Triangle triangle;
    for (int k = 0; k < 3; ++k) {
      if (corners[k] >= number_of.size()) {
        throw std::invalid_argument("a triangle without its corners");
      }
      triangle.corners[k] = number_of[corners[k]];
    }
    const Vec3 &a = corners_[triangle.corners[0]], &b = corners_[triangle.corners[1]],
               &c = corners_[triangle.corners[2]];
    const Vec3 area = cross(b - a, c - a);
    const double longest = std::max({dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)});
    if (norm(area) <= 1e-9 * longest) continue;  // a needle has no side
    triangle.normal = normalized(area);
    triangles_.push_back(triangle);
  }
}

// Finds the neighbours. Where more than two meet at an edge, each goes its own way.
void TriangleMeshShape::join() {
  using Edge = std::pair<std::uint32_t, std::uint32_t>;
  std::map<Edge, std::vector<std::pair<std::int32_t, int>>> users;  // by edge, in its direction
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    const auto& c = triangles_[i].corners;
    for (int k = 0; k < 3; ++k) users[{c[k], c[(k + 1) % 3]}].push_back({std::int32_t(i), k});
  }
  around_.resize(corners_.size());
  for (const auto& [edge, here] : users) {
    around_[edge.first].push_back(edge.second);
    around_[edge.second].push_back(edge.first);
    const auto there = users.find({edge.second, edge.first});
    const bool joined = there != users.end() && here.size() == 1 && there->second.size() == 1;
    for (const auto& [index, k] : here) {
      Triangle& triangle = triangles_[index];
      triangle.beyond[k] = -1;
      triangle.folds[k] = EdgeConvexity::convex;
      if (!joined) continue;
      const auto [other, side] = there->second[0];
      const std::uint32_t far_corner = triangles_[other].corners[(side + 2) % 3];
      triangle.beyond[k] = std::int32_t(far_corner);
      const double rise = dot(triangle.normal, corners_[far_corner] - corners_[edge.first]);
      triangle.folds[k] = rise > kLevel ? EdgeConvexity::concave : rise < -kLevel ? EdgeConvexity::convex : EdgeConvexity::flat;
      // Folded back upon itself, a sheet: level by the far corner alone.
      if (dot(triangle.normal, triangles_[other].normal) < 0 &&
          triangle.folds[k] == EdgeConvexity::flat) {
        triangle.folds[k] = EdgeConvexity::convex;
      }
    }
  }
  for (auto& list : around_) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
}

void TriangleMeshShape::mark_sharp() {
  std::vector<std::uint8_t> on_ridge(corners_.size(), 0);
  for (const Triangle& triangle : triangles_) {
    for (int k = 0; k < 3; ++k) {
      if (triangle.folds[k] != EdgeConvexity::convex) continue;
      on_ridge[triangle.corners[k]] = on_ridge[triangle.corners[(k + 1) % 3]] = 1;
    }
  }
  for (Triangle& triangle : triangles_) {
    for (const std::uint32_t corner : triangle.corners) {
      triangle.sharp = triangle.sharp || on_ridge[corner];
    }
  }
}

Aabb TriangleMeshShape::box_of(const Triangle& triangle) const {
  Aabb box;
  for (const std::uint32_t corner : triangle.corners) box.include(corners_[corner]);
  return box;
}

// Halves by the middles along the longest side.
int TriangleMeshShape::build(int first, int count) {
  const int number = int(nodes_.size());
  nodes_.emplace_back();
  Node node;
  node.first = first, node.count = count;
  Aabb middles;
  for (int i = first; i < first + count; ++i) {
    const Aabb box = box_of(triangles_[order_[i]]);
    node.box.include(box.min), node.box.include(box.max);
    middles.include(box.min + box.max);
  }
  if (count > kLeaf) {
    const Vec3 size = middles.max - middles.min;
    const int axis = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
    const auto key = [&](std::int32_t i) {
      const Aabb box = box_of(triangles_[i]);
      return std::make_pair((box.min + box.max)[axis], i);
    };
    std::sort(order_.begin() + first, order_.begin() + first + count,
              [&](std::int32_t a, std::int32_t b) { return key(a) < key(b); });
    build(first, count / 2);
    node.right = build(first + count / 2, count - count / 2);
  }
  nodes_[number] = node;
  return number;
}

void TriangleMeshShape::find(const Aabb& box, std::vector<std::int32_t>& found) const {
  found.clear();
  std::int32_t open[64];
  int depth = 0;
  open[depth++] = 0;
  while (depth > 0) {
    const std::int32_t number = open[--depth];
    const Node& node = nodes_[number];
    if (!overlap(node.box, box)) continue;
    if (node.right != 0) {
      open[depth++] = node.right;
      open[depth++] = number + 1;
      continue;
    }
    for (int i = node.first; i < node.first + node.count; ++i) {
      if (overlap(box_of(triangles_[order_[i]]), box)) found.push_back(order_[i]);
    }
  }
  std::sort(found.begin(), found.end());
}

bool TriangleMeshShape::meets(const Aabb& box) const {
  std::int32_t open[64];
  int depth = 0;
  open[depth++] = 0;
  while (depth > 0) {
    const std::int32_t number = open[--depth];
    const Node& node = nodes_[number];
    if (!overlap(node.box, box)) continue;
    if (node.right == 0) return true;
    open[depth++] = node.right;
    open[depth++] = number + 1;
  }
  return false;
}

bool TriangleMeshShape::is_exposed(const Triangle& triangle, const Vec3& normal) const {
  double height[3], highest = -1e300, longest = 0;
  for (int k = 0; k < 3; ++k) {
    const Vec3& corner = corners_[triangle.corners[k]];
    height[k] = dot(normal, corner);
    highest = std::max(highest, height[k]);
    longest = std::max(longest, distance(corner, corners_[triangle.corners[(k + 1) % 3]]));
  }
  bool top[3];
  for (int k = 0; k < 3; ++k) top[k] = height[k] > highest - kSameHeight * longest;
  const auto is_behind = [&](std::uint32_t corner, std::uint32_t from) {
    const Vec3 d = corners_[corner] - corners_[from];
    return dot(normal, d) <= kBehind * norm(d);
  };
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3, last = (k + 2) % 3;
    const std::uint32_t from = triangle.corners[k];
    if (top[k] && top[next] && !top[last]) {
      return triangle.beyond[k] < 0 || is_behind(std::uint32_t(triangle.beyond[k]), from);
    }
    if (!top[k] || top[next] || top[last]) continue;
    for (const std::uint32_t corner : around_[from]) {
      if (!is_behind(corner, from)) return false;
    }
    return true;
  }
  return true;  // the whole triangle
}

}  // namespace rubble
