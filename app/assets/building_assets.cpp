#include "app/assets/building_assets.h"

#include <algorithm>
#include <cmath>

#include "app/assets/rebar_stubs.h"
#include "kernel/base/hash.h"
#include "kernel/geometry/hull.h"
#include "kernel/structure/building.h"
#include "kernel/structure/buildings/site.h"

namespace rubble {
namespace {

constexpr double kLongestEdge = 0.35;  // of triangles: light is baked at their corners; unit: m
// Sides of a member lie along its axes; what is broken is tilted.
constexpr double kAlongAxis = 0.99999;
constexpr std::uint8_t kRebarSurface = 2;  // after the member's own face and its fracture

// Names of surfaces.
struct Looks {
  const char *face, *fracture;
};

Looks looks_of(const std::string& material) {
  if (material == "brick_masonry") return {"brickwork", "brick_fracture"};
  if (material == "block_masonry") return {"cinder_block", "cinder_block"};
  if (material == "timber") return {"timber", "timber_fracture"};
  return {"concrete_cast", "concrete_fracture"};
}

constexpr std::uint32_t kFirstTimber = 100000;  // numbers of bodies: after those of all storeys

class PieceMesh {
 public:
  PieceMesh(const PieceType& type, const Looks& looks) {
    mesh_.surface_names = {looks.face, looks.fracture, "rebar"};
    const Hull hull = calc_hull(type.parts[0].points);
    for (const auto& face : hull.faces) {
      Vec3 area;
      for (std::size_t i = 1; i + 1 < face.size(); ++i) {
        area += cross(hull.points[face[i]] - hull.points[face[0]], hull.points[face[i + 1]] - hull.points[face[0]]);
      }
      const Vec3 n = normalized(area);
      surface_ = std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)}) > kAlongAxis ? 0 : 1;
      for (std::size_t i = 1; i + 1 < face.size(); ++i) {
        add(hull.points[face[0]], hull.points[face[i]], hull.points[face[i + 1]]);
      }
    }
  }

  TriangleMesh take() { return std::move(mesh_); }

 private:
  // Halves the longest edge until all are short: both sides of an edge are cut at the same point.
  void add(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double ab = distance(a, b), bc = distance(b, c), ca = distance(c, a);
    if (std::max({ab, bc, ca}) <= kLongestEdge) {
      const std::uint32_t first = std::uint32_t(mesh_.positions.size());
      for (const Vec3& p : {a, b, c}) mesh_.positions.push_back(Vec3f(p));
      mesh_.triangles.push_back({first, first + 1, first + 2});
      mesh_.surfaces.push_back(surface_);
      return;
    }
    if (ab >= bc && ab >= ca) return halve(a, b, c);
    if (bc >= ca) return halve(b, c, a);
    halve(c, a, b);
  }

  void halve(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 middle = (a + b) * 0.5;
    add(a, middle, c);
    add(middle, b, c);
  }

  TriangleMesh mesh_;
  std::uint8_t surface_ = 0;
};

// What is cast or laid in one, a storey at a time, looks as one; each joist is another tree.
CutFrom find_cut(const Member& member, const StructurePiece& piece) {
  const bool along = member.kind == MemberKind::beam || member.kind == MemberKind::column;
  CutFrom cut;
  cut.grain = along ? longest_axis(member.size) : 0;
  if (member.material.name == "timber") {
    cut.body = kFirstTimber + std::uint32_t(piece.member);
    cut.origin = piece.position - member.centre;
  } else {
    cut.body = 1 + 4 * std::uint32_t(member.place.storey + 1) + std::uint32_t(member.kind);
    cut.origin = piece.position;
  }
  return cut;
}

std::string hash_piece(const PieceType& type, const TriangleMesh& mesh) {
  Sha256 hash;
  for (const double number : {type.density, type.friction}) hash.add(&number, sizeof number);
  for (const Vec3& p : type.parts[0].points) hash.add(&p, sizeof p);
  hash.add(mesh.positions.data(), mesh.positions.size() * sizeof mesh.positions[0]);
  return hash.hex();
}

}  // namespace

BuildingSpec building_of(const PileScenario& pile, std::uint64_t seed) {
  BuildingSpec building = pile.building;
  building.seed = seed;
  if (building.planned()) building.storeys = int(building.plan.heights.size());
  return building;
}

void add_building(const BuildingSpec& building, const Vec3& terrain_position, AssetLibrary& library) {
  if (!building.given()) return;
  library.structures = std::make_shared<const BuildingStructures>(build_structures(building));
  const Structure& made = library.structures->damaged;
  for (const int type : library.terrain()) check_site(made, *library.types[std::size_t(type)].surface, terrain_position);
  library.building_first_type = int(library.types.size());
  const std::vector<PieceType>& types = made.types;
  for (const StructurePiece& piece : made.pieces)
    library.building_cuts.push_back(find_cut(made.members[std::size_t(piece.member)], piece));
  for (std::size_t i = 0; i < types.size(); ++i) {
    auto mesh = std::make_shared<SceneMesh>();
    mesh->levels = {PieceMesh(types[i], looks_of(made.type_materials[i])).take()};
    add_rebar_stubs(types[i], made.type_bars[i], types[i].name, kRebarSurface, mesh->levels[0]);
    library.contents.push_back({types[i].name, kBuildingPack, hash_piece(types[i], mesh->levels[0]), 0, {1, 1}, {}});
    library.types.push_back(types[i]);
    library.meshes.push_back(std::move(mesh));
  }
}

}  // namespace rubble
