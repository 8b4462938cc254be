#include "kernel/surroundings/solid_surface.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace rubble {
namespace {

bool is_solid(SurroundingKind kind) { return kind != SurroundingKind::puddle && kind != SurroundingKind::skyline; }

// Of sheets that give way.
bool is_foliage(const std::string& look) { return look == "leaves" || look == "grass"; }

// By triangle of a mesh: whether it is solid. The ground looks like grass, too, but is no tuft of it.
std::vector<std::uint8_t> find_solid(const SurroundingMesh& mesh) {
  const TriangleMesh& finest = mesh.levels.front();
  std::vector<std::uint8_t> solid(finest.triangles.size(), 1);
  if (!mesh.leafy) return solid;
  for (std::size_t t = 0; t < solid.size() && t < finest.surfaces.size(); ++t)
    solid[t] = !is_foliage(finest.surface_names[finest.surfaces[t]]);
  return solid;
}

}  // namespace

TriangleMesh make_solid_surface(const Surroundings& surroundings, double reach) {
  std::vector<std::vector<std::uint8_t>> solid;
  for (const auto& mesh : surroundings.meshes) solid.push_back(find_solid(*mesh));
  TriangleMesh out;
  for (const SurroundingThing& thing : surroundings.things) {
    if (!is_solid(thing.kind)) continue;
    const TriangleMesh& mesh = surroundings.meshes[thing.mesh]->levels.front();
    std::vector<Vec3f> positions;
    positions.reserve(mesh.positions.size());
    for (const Vec3f& p : mesh.positions) positions.push_back(Vec3f(thing.world_from_mesh * (Vec3(p) * thing.scale)));
    const auto is_near = [&](std::uint32_t corner) {
      const Vec3f& p = positions[corner];
      return double(p.x) * double(p.x) + double(p.y) * double(p.y) < reach * reach;
    };
    std::vector<std::int64_t> number(positions.size(), -1);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& corners = mesh.triangles[t];
      if (!solid[thing.mesh][t] || !std::any_of(corners.begin(), corners.end(), is_near)) continue;
      std::array<std::uint32_t, 3> made;
      for (int k = 0; k < 3; ++k) {
        std::int64_t& known = number[corners[std::size_t(k)]];
        if (known < 0) {
          known = std::int64_t(out.positions.size());
          out.positions.push_back(positions[corners[std::size_t(k)]]);
        }
        made[std::size_t(k)] = std::uint32_t(known);
      }
      out.triangles.push_back({made[0], made[1], made[2]});
    }
  }
  return out;
}

}  // namespace rubble
