#include "kernel/base/mesh_edges.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <unordered_map>
#include <vector>

namespace rubble {
namespace {

struct SamePosition {
  bool operator()(const Vec3f& a, const Vec3f& b) const { return a.x == b.x && a.y == b.y && a.z == b.z; }
};

struct PositionHash {
  std::size_t operator()(const Vec3f& p) const {
    std::uint64_t hash = 0;
    for (const float x : {p.x, p.y, p.z}) {
      const float number = x + 0.0f;  // -0 is 0
      std::uint32_t bits;
      std::memcpy(&bits, &number, sizeof bits);
      hash = (hash ^ bits) * 0x9e3779b97f4a7c15u;
      hash ^= hash >> 29;
    }
    return std::size_t(hash);
  }
};

// By corner: a number that corners of one position share.
std::vector<std::uint32_t> weld(const TriangleMesh& mesh) {
  std::unordered_map<Vec3f, std::uint32_t, PositionHash, SamePosition> welded;
  welded.reserve(mesh.positions.size());
  std::vector<std::uint32_t> id;
  id.reserve(mesh.positions.size());
  for (const Vec3f& p : mesh.positions) id.push_back(welded.emplace(p, std::uint32_t(welded.size())).first->second);
  return id;
}

// From a corner to another one, both as weld() numbers them.
std::uint64_t key_of(std::uint32_t from, std::uint32_t to) { return std::uint64_t(from) << 32 | to; }

// How often each edge is used in each direction.
class EdgeUses {
 public:
  EdgeUses(const TriangleMesh& mesh, const std::vector<std::uint32_t>& id) {
    keys_.reserve(3 * mesh.triangles.size());
    for (const auto& t : mesh.triangles)
      for (int k = 0; k < 3; ++k) keys_.push_back(key_of(id[t[k]], id[t[(k + 1) % 3]]));
    std::sort(keys_.begin(), keys_.end());
  }
  const std::vector<std::uint64_t>& keys() const { return keys_; }  // sorted, each as often as it is used
  int count(std::uint64_t key) const {
    const auto [first, last] = std::equal_range(keys_.begin(), keys_.end(), key);
    return int(last - first);
  }

 private:
  std::vector<std::uint64_t> keys_;
};

std::string describe(const Vec3f& p) {
  char text[80];
  std::snprintf(text, sizeof text, "(%.4g, %.4g, %.4g)", double(p.x), double(p.y), double(p.z));
  return text;
}

}  // namespace

OpenEdges find_open_edges(const TriangleMesh& mesh) {
  const std::vector<std::uint32_t> id = weld(mesh);
  const EdgeUses uses(mesh, id);
  OpenEdges open;
  const std::vector<std::uint64_t>& keys = uses.keys();
  for (std::size_t i = 0; i < keys.size();) {
    const std::uint32_t from = std::uint32_t(keys[i] >> 32), to = std::uint32_t(keys[i]);
    std::size_t next = i + 1;
    while (next < keys.size() && keys[next] == keys[i]) ++next;
    const int back = uses.count(key_of(to, from));
    const bool told = back > 0 && from > to;  // from its other end
    if ((next - i != 1 || back != 1) && !told) ++open.count;
    i = next;
  }
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3 && open.count > 0 && open.triangles == 0; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      const int there = uses.count(key_of(id[a], id[b])), back = uses.count(key_of(id[b], id[a]));
      if (there == 1 && back == 1) continue;
      open.from = mesh.positions[a];
      open.to = mesh.positions[b];
      open.triangles = there + back;
    }
  return open;
}

std::string describe(const OpenEdges& edges) {
  const std::string first =
      "from " + describe(edges.from) + " to " + describe(edges.to) + ", by " +
      std::to_string(edges.triangles);
  if (edges.count == 1) return "an edge is not shared by two triangles, one each way: " + first;
  return std::to_string(edges.count) +
         " edges are not shared by two triangles, one each way; the first, " + first;
}

}  // namespace rubble
