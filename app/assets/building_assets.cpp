#include "app/assets/building_assets.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/hash.h"
#include "kernel/base/portable_math.h"
#include "kernel/base/random.h"
#include "kernel/geometry/hull.h"
#include "kernel/structure/building.h"

namespace rubble {
namespace {

constexpr double kBroken = 0.99999;   // faces whose normal is nearer to an axis are sides of the member; unit: 1
constexpr double kSpacing = 0.35;     // of bars along the edges of a face; unit: m
constexpr double kInside = 0.03;      // where a bar begins, behind the face; unit: m
constexpr double kShortest = 0.06, kLongest = 0.4;  // of what sticks out; unit: m
constexpr double kMostBend = 0.5;     // towards the face's middle, of the way there; unit: 1
constexpr double kThinnest = 0.008, kThickest = 0.032;  // diameters of bars; unit: m
constexpr int kSegments = 2;          // of a bent bar; unit: 1

// A broken face, seen along the axis that its bars run along.
struct Face {
  std::vector<Vec3> corners;
  Vec3 normal, middle;
  int axis = 0;
  double area = 0;  // across the axis; unit: m2
};

// The point of a face's plane above (u, v), the coordinates across its axis.
Vec3 on_plane(const Face& face, double u, double v) {
  Vec3 p;
  const int s = (face.axis + 1) % 3, t = (face.axis + 2) % 3;
  p[s] = u, p[t] = v;
  const double along = dot(face.normal, face.middle) - face.normal[s] * u - face.normal[t] * v;
  p[face.axis] = along / face.normal[face.axis];
  return p;
}

bool is_inside(const Face& face, const Vec3& p, double margin) {
  for (std::size_t i = 0; i < face.corners.size(); ++i) {
    const Vec3& a = face.corners[i];
    const Vec3 edge = face.corners[(i + 1) % face.corners.size()] - a;
    const Vec3 inwards = normalized(cross(face.normal, edge));
    if (dot(inwards, p - a) < margin) return false;
  }
  return true;
}

// Along both longer edges of the face's box, at the depth of the cover.
std::vector<Vec3> place_bars(const Face& face, double cover) {
  const int s = (face.axis + 1) % 3, t = (face.axis + 2) % 3;
  double low[2] = {1e30, 1e30}, high[2] = {-1e30, -1e30};
  for (const Vec3& p : face.corners) {
    low[0] = std::min(low[0], p[s]), high[0] = std::max(high[0], p[s]);
    low[1] = std::min(low[1], p[t]), high[1] = std::max(high[1], p[t]);
  }
  const double inset = cover;
  const bool wide = high[0] - low[0] >= high[1] - low[1];
  const int along = wide ? 0 : 1, across = 1 - along;
  const double length = high[along] - low[along] - 2 * inset, depth = high[across] - low[across] - 2 * inset;
  std::vector<Vec3> places;
  if (length < 0 || depth < 0) return places;
  const int count = std::max(2, int(length / kSpacing) + 1);
  for (const double side : {0.0, 1.0}) {
    for (int i = 0; i < count; ++i) {
      double uv[2];
      uv[along] = low[along] + inset + length * i / (count - 1);
      uv[across] = low[across] + inset + depth * side;
      const Vec3 p = on_plane(face, uv[0], uv[1]);
      if (is_inside(face, p, 0.5 * cover)) places.push_back(p);
    }
  }
  return places;
}

// A prism of three sides around a bent line, closed at both ends.
void add_bar(const std::vector<Vec3>& line, double radius, int axis, std::uint8_t surface, TriangleMesh& mesh) {
  const auto first = std::uint32_t(mesh.positions.size());
  const int s = (axis + 1) % 3, t = (axis + 2) % 3;
  for (const Vec3& p : line) {
    for (int k = 0; k < 3; ++k) {
      const portable::SinCos turn = portable::sincos(2 * portable::kPi * k / 3);
      Vec3 corner = p;
      corner[s] += radius * turn.cos, corner[t] += radius * turn.sin;
      mesh.positions.push_back(Vec3f(corner));
    }
  }
  // Corners go round the axis: which way is out depends on where the bar points.
  const bool forwards = line.back()[axis] > line.front()[axis];
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (!forwards) std::swap(b, c);
    mesh.triangles.push_back({first + a, first + b, first + c});
    mesh.surfaces.push_back(surface);
  };
  const auto rings = std::uint32_t(line.size());
  for (std::uint32_t ring = 0; ring + 1 < rings; ++ring) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t a = 3 * ring + k, b = 3 * ring + (k + 1) % 3;
      add(a, b, b + 3);
      add(a, b + 3, a + 3);
    }
  }
  const std::uint32_t end = 3 * (rings - 1);
  add(end, end + 1, end + 2);
  add(0, 2, 1);
}

std::vector<Face> find_broken(const PieceType& type) {
  std::vector<Face> faces;
  const Hull hull = calc_hull(type.parts[0].points);
  for (const auto& corners : hull.faces) {
    Face face;
    Vec3 area;
    for (const int corner : corners) {
      face.corners.push_back(hull.points[corner]);
      face.middle += hull.points[corner] * (1 / double(corners.size()));
    }
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
      area += cross(face.corners[i] - face.corners[0], face.corners[i + 1] - face.corners[0]) * 0.5;
    }
    face.normal = normalized(area);
    for (int axis = 1; axis < 3; ++axis) {
      if (std::abs(face.normal[axis]) > std::abs(face.normal[face.axis])) face.axis = axis;
    }
    face.area = std::abs(area[face.axis]);
    if (std::abs(face.normal[face.axis]) < kBroken) faces.push_back(face);
  }
  return faces;
}

// Adds to a piece's mesh, as surface number `surface`, the bars that cross its broken faces: along the
// face's edges at the depth of the cover, bent towards its middle, each of its own length. While the piece
// still stands beside its neighbour they are inside of that one, where nobody sees them. Nothing where the
// member has no bars. seed_name: of the stream that lengths and bends are drawn from.
void add_rebar_stubs(const PieceType& type, const Reinforcement& bars, const std::string& seed_name,
                     std::uint8_t surface, TriangleMesh& mesh) {
  if (!(bars.ratio > 0)) return;
  RandomStream random(0, "rebar " + seed_name);
  for (const Face& face : find_broken(type)) {
    const std::vector<Vec3> places = place_bars(face, bars.cover);
    if (places.empty()) continue;
    const double area = bars.ratio * face.area / double(places.size());
    const double radius = 0.5 * std::clamp(std::sqrt(4 * area / portable::kPi), kThinnest, kThickest);
    const double out = face.normal[face.axis] > 0 ? 1 : -1;
    for (const Vec3& place : places) {
      const double length = random.uniform(kShortest, kLongest), bend = random.uniform(0, kMostBend);
      Vec3 aside = face.middle - place;
      aside[face.axis] = 0;
      std::vector<Vec3> line{place};
      line[0][face.axis] -= out * kInside;
      for (int i = 1; i <= kSegments; ++i) {
        const double share = double(i) / kSegments;
        Vec3 p = place + aside * (bend * share * share);
        p[face.axis] = place[face.axis] + out * length * share;
        line.push_back(p);
      }
      add_bar(line, radius, face.axis, surface, mesh);
    }
  }
}

constexpr double kLongestEdge = 0.35;  // of triangles: light is baked at their corners; unit: m
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
      surface_ = std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)}) > kBroken ? 0 : 1;
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
