#include "kernel/base/mesh_edges.h"

#include <cstdio>
#include <map>
#include <tuple>
#include <utility>

namespace rubble {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

std::vector<std::uint32_t> weld(const TriangleMesh& mesh) {
  std::map<std::tuple<float, float, float>, std::uint32_t> welded;
  std::vector<std::uint32_t> id;
  for (const Vec3f& p : mesh.positions)
    id.push_back(
        welded.emplace(std::make_tuple(p.x, p.y, p.z), std::uint32_t(welded.size())).first->second);
  return id;
}

std::string describe(const Vec3f& p) {
  char text[80];
  std::snprintf(text, sizeof text, "(%.4g, %.4g, %.4g)", double(p.x), double(p.y), double(p.z));
  return text;
}

}  // namespace

OpenEdges find_open_edges(const TriangleMesh& mesh) {
  const std::vector<std::uint32_t> id = weld(mesh);
  std::map<Edge, int> uses;  // with its direction
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) ++uses[{id[t[k]], id[t[(k + 1) % 3]]}];
  const auto count = [&uses](std::uint32_t a, std::uint32_t b) {
    const auto found = uses.find({a, b});
    return found == uses.end() ? 0 : found->second;
  };
  OpenEdges open;
  for (const auto& [edge, there] : uses) {
    const int back = count(edge.second, edge.first);
    const bool told = back > 0 && edge.first > edge.second;  // from its other end
    if ((there != 1 || back != 1) && !told) ++open.count;
  }
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3 && open.count > 0 && open.triangles == 0; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      const int there = count(id[a], id[b]), back = count(id[b], id[a]);
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
