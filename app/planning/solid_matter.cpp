#include "app/planning/solid_matter.h"

#include <cstdio>
#include <limits>

#include "kernel/geometry/fine_shapes.h"
#include "kernel/queries/query_triangle.h"

namespace rubble {
namespace {

constexpr double kInside = 0.5;  // winding number
// Of surroundings: houses are open below, and where their windows are. From 0.43 inside of those of a street, below 0 outside.
constexpr double kInsideOfShell = 0.25;
const char* const kBelow = "below the ground";

bool contains(const Aabb& box, const Vec3& p, int axes = 3) {
  for (int i = 0; i < axes; ++i)
    if (p[i] < box.min[i] || p[i] > box.max[i]) return false;
  return true;
}

// Of a sheet without a floor. A point is below it where what is next above faces up; the ceiling of a cave faces down.
bool is_below(const TriangleMesh& mesh, const Vec3& point) {
  double nearest = std::numeric_limits<double>::infinity();
  bool faces_up = false;
  for (const auto& t : mesh.triangles) {
    const Vec3 a = Vec3(mesh.positions[t[0]]) - point, b = Vec3(mesh.positions[t[1]]) - point, c = Vec3(mesh.positions[t[2]]) - point;
    const double u = b.x * c.y - b.y * c.x, v = c.x * a.y - c.y * a.x, w = a.x * b.y - a.y * b.x;
    if (!(u >= 0 && v >= 0 && w >= 0) && !(u <= 0 && v <= 0 && w <= 0)) continue;
    const double area = u + v + w;  // twice that of the triangle seen from above; positive: it faces up
    const double height = (a.z * u + b.z * v + c.z * w) / area;
    if (area != 0 && height > 0 && height < nearest) nearest = height, faces_up = area > 0;
  }
  return faces_up;
}

}  // namespace

double calc_winding_number(const TriangleMesh& mesh, const Vec3& point) {
  double sum = 0;
  for (const auto& t : mesh.triangles)
    sum += calc_winding({Vec3(mesh.positions[t[0]]), Vec3(mesh.positions[t[1]]), Vec3(mesh.positions[t[2]])}, point);
  return sum;
}

SolidMatter::SolidMatter(const AssetLibrary& assets, const PileState& pile) {
  add_pieces(assets, pile);
  add_fines(pile);
  if (pile.surroundings) add_surroundings(*pile.surroundings);
}

void SolidMatter::add_pieces(const AssetLibrary& assets, const PileState& pile) {
  const std::vector<const TriangleMesh*> meshes = assets.finest_meshes();
  std::vector<const Aabb*> boxes;
  for (const TriangleMesh* mesh : meshes) boxes.push_back(box_of(*mesh));
  std::vector<bool> is_terrain(meshes.size());
  for (const int type : assets.terrain()) is_terrain[std::size_t(type)] = true;
  for (std::size_t i = 0; i < pile.pieces.size(); ++i) {
    const PieceState& piece = pile.pieces[i];
    const auto type = std::size_t(piece.type);
    if (piece.status == PieceStatus::lost || type >= meshes.size()) continue;
    bodies_.push_back({meshes[type], boxes[type], piece.world_from_body, piece.scale, is_terrain[type], kInside,
                       "inside piece " + std::to_string(i) + " (" + pile.types[type] + ")"});
  }
}

void SolidMatter::add_fines(const PileState& pile) {
  if (pile.fines.empty()) return;
  for (const FineHeap& heap : pile.fines.heaps())
    bodies_.push_back({&heap.mesh, box_of(heap.mesh), world_from_host(pile, heap.host), 1, false, kInside,
                       "inside fines (" + fine_names()[std::size_t(heap.kind)] + ")"});
}

void SolidMatter::add_surroundings(const Surroundings& surroundings) {
  using Kind = SurroundingKind;
  std::vector<const Aabb*> boxes;
  for (const auto& mesh : surroundings.meshes) boxes.push_back(box_of(mesh->levels.front()));
  for (const SurroundingThing& thing : surroundings.things) {
    const SurroundingMesh& mesh = *surroundings.meshes[thing.mesh];
    if (mesh.leafy || thing.kind == Kind::puddle || thing.kind == Kind::skyline) continue;
    const bool is_ground = thing.kind == Kind::road || thing.kind == Kind::pavement || thing.kind == Kind::soil;
    bodies_.push_back({&mesh.levels.front(), boxes[thing.mesh], thing.world_from_mesh, thing.scale, is_ground, kInsideOfShell,
                       "inside surroundings (" + surrounding_names()[std::size_t(thing.kind)] + ")"});
  }
}

std::string SolidMatter::describe(const Vec3& point) const {
  for (const Body& body : bodies_) {
    const Vec3 local = body.world_from_mesh.inverse() * point * (1 / body.scale);
    if (body.is_ground) {
      if (contains(*body.box, local, 2) && local.z < body.box->max.z && is_below(*body.mesh, local)) return kBelow;
    } else if (contains(*body.box, local) && calc_winding_number(*body.mesh, local) >= body.least_winding) {
      return body.what;
    }
  }
  return point.z < 0 ? kBelow : "";
}

std::optional<std::string> SolidMatter::warn_of(const std::string& who, const std::vector<Vec3>& positions, bool rides) const {
  std::size_t frames = 0, first = 0;
  std::string where;
  for (std::size_t f = 0; f < positions.size(); ++f) {
    const std::string found = describe(positions[f]);
    if (found.empty()) continue;
    if (frames++ == 0) first = f, where = found;
  }
  if (frames == 0) return std::nullopt;
  const Vec3& at = positions[first];
  char place[96];
  std::snprintf(place, sizeof place, "{%.2f, %.2f, %.2f}", at.x, at.y, at.z);
  return who + " is " + where + " at frame " + std::to_string(first) + ", " + place +
         ", and inside something or below the ground at " + std::to_string(frames) + " of " + std::to_string(positions.size()) +
         " frames: " + (rides ? "move it on its robot, or the robot's way" : "move its path, or fly with trajectory.plan = \"avoid\"");
}

}  // namespace rubble
