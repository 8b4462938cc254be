// A pile before it falls: piece types, placed pieces, and the layers to drop.
//
//   PileSpec --generate_pile--> Pile --settle_pile--> PileState
//
// Lengths in metres, masses in kg, times in s, angles in rad. World frame: Z up, ground z = 0.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kernel/base/math.h"
#include "kernel/base/mesh.h"
#include "kernel/model/assembly.h"
#include "kernel/model/building.h"
#include "kernel/model/size_distribution.h"

namespace rubble {

struct BuildingStructures;  // kernel/structure/building.h

// The convex hull of some points, in the frame of the piece. At least 4 points, not coplanar.
struct ConvexPart {
  std::vector<Vec3> points;  // unit: m
};

// Of a piece type; unit: kg/m3.
inline constexpr double kLeastDensity = 10, kMostDensity = 20000;

// One kind of piece. All lengths at scale 1.
struct PieceType {
  std::string name;               // unique among the types of a pile
  std::vector<ConvexPart> parts;  // collision geometry; at least one, or a surface
  // Terrain: collides by its triangles, from their front side, and is always fixed. It may be open, but
  // only a closed surface has an inside for queries and void maps. At more than 5 m/s, bars a few
  // centimetres thin may pass through a sheet with spikes.
  std::shared_ptr<const TriangleMesh> surface;
  // Volume, centre of mass and inertia at density 1; without it, the sum over the parts.
  std::optional<VolumeProperties> volume;
  double density = 2400;  // unit: kg/m3; range: kLeastDensity to kMostDensity
  double friction = 0.8;  // Coulomb, against concrete; a pair has the geometric mean; range: 0 to 2
};

// What is placed or drawn: a type, or an assembly of types, by its index in the pile's list of them.
struct PieceKind {
  constexpr PieceKind(int type = 0) : index(type) {}
  static constexpr PieceKind assembly(int index);
  int index;
  bool is_assembly = false;
};
constexpr PieceKind PieceKind::assembly(int index) {
  PieceKind kind(index);
  kind.is_assembly = true;
  return kind;
}
constexpr bool operator==(PieceKind a, PieceKind b) { return a.index == b.index && a.is_assembly == b.is_assembly; }
constexpr bool operator!=(PieceKind a, PieceKind b) { return !(a == b); }

// What there is of each kind: shapes, boxes.
template <typename T>
struct ByKind {
  std::vector<T> types, assemblies;
  const T& operator[](PieceKind kind) const {
    return (kind.is_assembly ? assemblies : types)[std::size_t(kind.index)];
  }
  bool has(PieceKind kind) const {
    return kind.index >= 0 && std::size_t(kind.index) < (kind.is_assembly ? assemblies : types).size();
  }
};

// How often a kind is drawn and how large.
struct MixEntry {
  PieceKind kind;
  double weight = 1;          // relative; >= 0
  double scale_min = 1;       // from scale_min to scale_max; range: 0.01 to 100
  double scale_max = 1;       // range: scale_min and up, to 100
  SizeDistribution spread{};  // between them
};

struct Placement {
  PieceKind kind;
  double scale = 1;  // of the type's or the assembly's lengths; range: 0.01 to 100
  Pose world_from_body;  // body: the frame of the type's parts (not the centre of mass) or of the
                         // assembly
  bool fixed = false;    // immovable: walls, pipes, terrain; of an assembly only the root
};

// Horizontal density of the pieces of a layer: a grid of weights over the spawn box, uniform within a
// cell. Rows from the lowest y, each from the lowest x. Without weights the density is uniform.
struct SpawnDensity {
  int columns = 0, rows = 0;    // range: 1 to 256
  std::vector<double> weights;  // columns * rows, finite, >= 0, at least one above 0
};

// Pieces that stand on every floor of a building.
struct Furnishing {
  PieceKind kind;
  double per_bay = 1;  // mean number in each bay of each floor; range: 0 to 20
  bool roof = false;   // also on the roof
};

// Where and how much to drop.
struct PileSpec {
  std::uint64_t seed = 0;                // of all random draws
  std::vector<PieceType> types;          // indexed by PieceKind, as the assemblies are
  std::vector<AssemblyType> assemblies;
  std::vector<MixEntry> mix;             // source of the layers; not empty if there are layers
  std::vector<Placement> placed;         // pieces that are there before the first layer
  Vec3 spawn_position{0, 0, 4.5};        // centre of the spawn box; unit: m
  Vec3 spawn_bounds{10, 10, 7};          // its full edge lengths; unit: m; > 0
  SpawnDensity spawn_density;            // over the footprint of the spawn box
  // A building that collapses before the first layer falls, and the index of its first piece type.
  BuildingSpec building;
  int building_first_type = 0;  // index into the types; 0 without a building
  std::shared_ptr<const BuildingStructures> structures;  // of the building; null: they are built where they are needed
  std::vector<Furnishing> furniture;  // of the building
  int layers = 4;               // 0 to 1000
  int pieces_per_layer = 300;   // 0 to 100000; an assembly counts as one
};

// Poses of a layer are relative to the bottom of the spawn box (z) and to the world (x, y).
struct Layer {
  std::vector<Placement> pieces;  // in the order in which they are added to the world
};

struct Pile {
  std::vector<PieceType> types;          // as in the PileSpec
  std::vector<AssemblyType> assemblies;  // as in the PileSpec
  std::vector<Placement> placed;         // before the first layer
  BuildingSpec building;                 // collapses before the first layer falls
  int building_first_type = 0;           // as in the PileSpec
  std::shared_ptr<const BuildingStructures> structures;  // as in the PileSpec
  std::vector<Layer> layers;             // in the order in which they fall
  // Height above the terrain under the spawn box. Layer k starts at this height, or 1 m above the highest point of
  // the pile if that is higher.
  double spawn_bottom = 1.0;  // unit: m
};

}  // namespace rubble
