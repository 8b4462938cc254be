// Surroundings of a pile: a street with kerbs and pavements, neighbouring buildings, trees, fences, parked
// vehicles, street lamps, uneven ground, and the skyline.
//
//   SurroundingsSpec + seed + the circle of the pile --make_surroundings--> Surroundings
//
// Surroundings are true geometry: they are drawn, labelled and exported, count in queries, and are felt by robots
// (make_surroundings.h). The pile settles without them.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "kernel/base/math.h"
#include "kernel/base/mesh.h"

namespace rubble {

// In the order of their classes in the stream `label`.
enum class SurroundingKind : std::uint8_t {
  road,
  kerb,
  pavement,
  soil,
  building,
  tree,
  fence,
  vehicle,
  street_lamp,
  puddle,
  skyline
};
inline constexpr int kSurroundingKinds = 11;
// Their names: "road", "kerb", ...
const std::array<std::string, kSurroundingKinds>& surrounding_names();

enum class SurroundingsType { none, street };
enum class StreetLampState { automatic, on, off };

struct SurroundingsSpec {
  SurroundingsType type = SurroundingsType::none;  // none: the plain
  double clearance = 2;                  // free distance around the pile; unit: m; range: 0.5 to 200
  double reach = 120;                    // of the detailed part, along the street; unit: m; range: 40 to 400
  double turn_deg = 0;                   // of the street from the X axis towards Y; unit: degree
  std::array<double, 2> storeys{2, 5};   // smallest and largest number, integers; range: 1 to 12
  double trees = 0.6;                    // share of the places for trees that have one; range: 0 to 1
  double vehicles = 0.5;                 // share of the places for vehicles that have one; range: 0 to 1
  double lit_windows = 0.3;              // share of lit windows while street lamps are lit; range: 0 to 1
  StreetLampState lamps = StreetLampState::automatic;  // automatic: lit when it is dark

  bool on() const { return type != SurroundingsType::none; }
};

// A mesh that several things may share.
struct SurroundingMesh {
  std::vector<TriangleMesh> levels;  // finest first; at least one
  double light_spacing = 1;          // distance between bake points; unit: m
  bool leafy = false;  // many sheets without an inside: queries use the coarsest level
};

// One object with a number of its own.
struct SurroundingThing {
  SurroundingKind kind = SurroundingKind::road;
  std::uint32_t mesh = 0;  // index into Surroundings::meshes
  Pose world_from_mesh;    // unit: m
  double scale = 1;        // of the mesh; range: above 0
};

struct Surroundings {
  std::vector<std::shared_ptr<const SurroundingMesh>> meshes;
  std::vector<SurroundingThing> things;  // in the order of their numbers
  std::vector<Vec3> lamps;               // positions of the street lamps, nearest to the pile first
  bool lit = false;                      // whether the street lamps shine
};

// The number of the first thing in the stream `instance`, in exports and in results of queries. It is above the
// numbers of heaps of fines. A float holds it exactly.
inline constexpr int kFirstSurrounding = 12'000'000;

}  // namespace rubble
