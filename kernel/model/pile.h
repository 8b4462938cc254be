// What a pile is before it falls: piece types, what stands already, and the layers to drop.
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

// The convex hull of some points, in the frame of the piece. At least 4 points, not coplanar.
struct ConvexPart {
  std::vector<Vec3> points;  // unit: m
};

// One kind of piece. All lengths at scale 1.
struct PieceType {
  std::string name;               // unique among the types of a pile
  std::vector<ConvexPart> parts;  // collision geometry; at least one, or a surface
  // Terrain: collides by its own triangles, from the side that they face, and can only be fixed. It
  // need not be closed, but only what is closed has an inside for queries and void maps. Bars a few
  // centimetres thin may go through a sheet with spikes at more than 5 m/s.
  std::shared_ptr<const TriangleMesh> surface;
  // Volume, centre of mass and inertia at density 1; without it, the sum over the parts.
  std::optional<VolumeProperties> volume;
  double density = 2400;  // unit: kg/m3; range: 10 to 20000
  double friction = 0.8;  // Coulomb, against concrete; a pair has the geometric mean; 0 to 2
};

// How often a type is drawn and how large.
struct MixEntry {
  int type = 0;               // index into the types, or their number plus that of an assembly
  double weight = 1;          // relative; >= 0
  double scale_min = 1;       // from scale_min to scale_max; range: 0.01 to 100
  double scale_max = 1;       // range: scale_min and up, to 100
  SizeDistribution spread{};  // between them
};

struct Placement {
  int type = 0;          // as in MixEntry
  double scale = 1;  // of the type's or the assembly's lengths; range: 0.01 to 100
  Pose world_from_body;  // body: the frame of the type's parts, not the centre of mass; or the
                         // assembly's
  bool fixed = false;    // immovable: walls, pipes, terrain; of an assembly its root alone
};

// Where above its footprint a layer's pieces are drawn: a grid of weights over the spawn box, even
// within a cell. Row by row from the lowest y, each from the lowest x; without weights: evenly.
struct SpawnDensity {
  int columns = 0, rows = 0;    // range: 1 to 256
  std::vector<double> weights;  // columns * rows, finite, >= 0, at least one above 0
};

// Pieces that stand on every floor of a building.
struct Furnishing {
  int type = 0;        // as in MixEntry
  double per_bay = 1;  // mean number in each bay of each floor; range: 0 to 20
  bool roof = false;   // also on the roof
};

// Where and how much to drop.
struct PileSpec {
  std::uint64_t seed = 0;                // of all that is drawn at random
  std::vector<PieceType> types;          // what MixEntry::type and Placement::type count
  std::vector<AssemblyType> assemblies;  // counted on after the types
  std::vector<MixEntry> mix;             // what layers are drawn from; not empty where there are layers
  std::vector<Placement> placed;         // stands or is laid down before the first layer
  Vec3 spawn_position{0, 0, 4.5};        // centre of the spawn box; unit: m
  Vec3 spawn_bounds{10, 10, 7};          // its full edge lengths; unit: m; > 0
  SpawnDensity spawn_density;            // over the footprint of the spawn box
  // A building that collapses before the first layer falls; its pieces' types begin at this one.
  BuildingSpec building;
  int building_first_type = 0;  // index into the types; 0 without a building
  std::vector<Furnishing> furniture;  // of the building
  int layers = 4;               // 0 to 1000
  int pieces_per_layer = 300;   // 0 to 100000; an assembly counts as one
};

// A layer's poses are relative to the bottom of the spawn volume (z) and to the world (x, y).
struct Layer {
  std::vector<Placement> pieces;  // in the order in which they are added to the world
};

struct Pile {
  std::vector<PieceType> types;          // as in the PileSpec
  std::vector<AssemblyType> assemblies;  // as in the PileSpec
  std::vector<Placement> placed;         // before the first layer
  BuildingSpec building;                 // collapses before the first layer falls
  int building_first_type = 0;           // as in the PileSpec
  std::vector<Layer> layers;             // in the order in which they fall
  // Above the terrain under the spawn box. Layer k starts at the larger of this height and 1 m above the highest point of the pile.
  double spawn_bottom = 1.0;  // unit: m
};

}  // namespace rubble
