#include "io/import/mesh_winding.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

namespace rubble {

namespace {

// One side of an edge, as a triangle has it.
struct HalfEdge {
  std::uint32_t low, high, triangle;
  bool upward;  // from the lower number to the higher
  bool operator<(const HalfEdge& o) const { return std::tie(low, high, triangle) < std::tie(o.low, o.high, o.triangle); }
};

struct Neighbour {
  std::uint32_t triangle;
  bool agrees;
};

using Neighbours = std::vector<std::array<Neighbour, 3>>;

// Numbers of corners; those at one place have one.
std::vector<std::uint32_t> number_places(const TriangleMesh& mesh) {
  std::map<std::tuple<float, float, float>, std::uint32_t> places;
  std::vector<std::uint32_t> numbers;
  numbers.reserve(mesh.positions.size());
  for (const Vec3f& p : mesh.positions)
    numbers.push_back(places.emplace(std::make_tuple(p.x, p.y, p.z), std::uint32_t(places.size())).first->second);
  return numbers;
}

// Across each edge of each triangle; empty: an edge is not shared by two.
Neighbours find_neighbours(const TriangleMesh& mesh) {
  const std::vector<std::uint32_t> numbers = number_places(mesh);
  std::vector<HalfEdge> edges;
  edges.reserve(mesh.triangles.size() * 3);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = numbers[mesh.triangles[t][k]], b = numbers[mesh.triangles[t][(k + 1) % 3]];
      edges.push_back({std::min(a, b), std::max(a, b), t, a < b});
    }
  std::sort(edges.begin(), edges.end());
  Neighbours neighbours(mesh.triangles.size());
  std::vector<std::uint8_t> found(mesh.triangles.size(), 0);
  for (std::size_t i = 0; i < edges.size(); i += 2) {
    const auto same = [&](std::size_t j) {
      return j < edges.size() && edges[j].low == edges[i].low && edges[j].high == edges[i].high;
    };
    if (!same(i + 1) || same(i + 2)) return {};
    const HalfEdge &one = edges[i], &other = edges[i + 1];
    const bool agrees = one.upward != other.upward;
    if (one.triangle == other.triangle || found[one.triangle] == 3 || found[other.triangle] == 3) return {};
    neighbours[one.triangle][found[one.triangle]++] = {other.triangle, agrees};
    neighbours[other.triangle][found[other.triangle]++] = {one.triangle, agrees};
  }
  return neighbours;
}

struct Component {
  std::vector<std::uint32_t> triangles;
  Aabb box;
  double volume = 0;  // six times
};

class Winding {
 public:
  Winding(TriangleMesh& mesh, const Neighbours& neighbours)
      : mesh_(mesh), neighbours_(neighbours), turned_(mesh.triangles.size(), kUnseen) {}

  // False: the surface has no two sides.
  bool agree() {
    for (std::uint32_t t = 0; t < turned_.size(); ++t)
      if (turned_[t] == kUnseen && !follow(t)) return false;
    for (Component& component : components_) turn_fewer(component);
    for (Component& component : components_) measure(component);
    for (const Component& component : components_)
      if (component.volume < 0 && !lies_within_another(component))
        for (const std::uint32_t t : component.triangles) turned_[t] ^= 1;
    return true;
  }

  std::size_t apply() {
    std::size_t count = 0;
    for (std::uint32_t t = 0; t < turned_.size(); ++t) {
      if (turned_[t] == 0) continue;
      ++count;
      std::swap(mesh_.triangles[t][1], mesh_.triangles[t][2]);
      if (!mesh_.paint_corners.empty()) std::swap(mesh_.paint_corners[t][1], mesh_.paint_corners[t][2]);
    }
    if (count > 0 && !mesh_.normals.empty()) turn_normals();
    return count;
  }

 private:
  // The file's normals may point outwards already, whatever its triangles do.
  void turn_normals() {
    std::vector<double> agreement(mesh_.normals.size(), 0);
    std::vector<char> near_turned(mesh_.normals.size(), 0);
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const auto& corners = mesh_.triangles[t];
      const Vec3 a(mesh_.positions[corners[0]]), b(mesh_.positions[corners[1]]), c(mesh_.positions[corners[2]]);
      const Vec3 normal = cross(b - a, c - a);
      for (const std::uint32_t v : corners)
        agreement[v] += dot(Vec3(mesh_.normals[v]), normal), near_turned[v] |= char(turned_[t]);
    }
    for (std::size_t v = 0; v < agreement.size(); ++v)
      if (near_turned[v] && agreement[v] < 0) mesh_.normals[v] = Vec3f(Vec3(mesh_.normals[v]) * -1.0);
  }

  static constexpr std::uint8_t kUnseen = 2;

  bool follow(std::uint32_t first) {
    Component component;
    component.triangles.push_back(first), turned_[first] = 0;
    for (std::size_t i = 0; i < component.triangles.size(); ++i) {
      const std::uint32_t t = component.triangles[i];
      for (const Neighbour& n : neighbours_[t]) {
        const auto wanted = std::uint8_t(n.agrees ? turned_[t] : turned_[t] ^ 1);
        if (turned_[n.triangle] == kUnseen)
          turned_[n.triangle] = wanted, component.triangles.push_back(n.triangle);
        else if (turned_[n.triangle] != wanted)
          return false;
      }
    }
    components_.push_back(std::move(component));
    return true;
  }

  void turn_fewer(const Component& component) {
    std::size_t turned = 0;
    for (const std::uint32_t t : component.triangles) turned += turned_[t];
    if (turned * 2 <= component.triangles.size()) return;
    for (const std::uint32_t t : component.triangles) turned_[t] ^= 1;
  }

  void measure(Component& component) const {
    for (const std::uint32_t t : component.triangles) {
      Vec3 p[3];
      for (std::size_t k = 0; k < 3; ++k) p[k] = Vec3(mesh_.positions[mesh_.triangles[t][k]]), component.box.include(p[k]);
      component.volume += (turned_[t] ? -1 : 1) * dot(p[0], cross(p[1], p[2]));
    }
  }

  bool lies_within_another(const Component& component) const {
    return std::any_of(components_.begin(), components_.end(), [&](const Component& o) {
      bool within = true;
      for (int i = 0; i < 3; ++i) within = within && o.box.min[i] < component.box.min[i] && component.box.max[i] < o.box.max[i];
      return within;
    });
  }

  TriangleMesh& mesh_;
  const Neighbours& neighbours_;
  std::vector<std::uint8_t> turned_;  // 0, 1 or kUnseen
  std::vector<Component> components_;
};

}  // namespace

std::string agree_on_outside(TriangleMesh& mesh) {
  if (mesh.triangles.empty() || (is_closed(mesh) && calc_volume_properties(mesh).volume > 0)) return "";
  const Neighbours neighbours = find_neighbours(mesh);
  if (neighbours.empty()) return "";
  Winding winding(mesh, neighbours);
  if (!winding.agree()) return "";
  const std::size_t all = mesh.triangles.size(), count = winding.apply();
  if (count == 0) return "";
  if (count == all) return "its triangles face inwards: all are turned";
  return std::to_string(count) + " of its " + std::to_string(all) + " triangles face inwards: they are turned";
}

}  // namespace rubble
