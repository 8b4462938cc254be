// The pile as a flight sees it, and the voids that a mission names.
#pragma once

#include <optional>
#include <vector>

#include "app/assets/asset_library.h"
#include "app/planning/flight.h"
#include "kernel/queries/queries.h"
#include "kernel/voids/void_map.h"

namespace rubble {

// The true meshes of a settled pile, to be asked exactly.
struct PileGeometry {
  PileGeometry(const AssetLibrary& assets, const PileState& state);

  const PileState& pile;
  std::vector<const TriangleMesh*> meshes;  // by type
  std::vector<int> terrain;                 // types that are
  PileQueries queries;
};

// Its free space in voxels, as fine as the smallest sphere that the flight names asks for. It takes
// seconds to make, so it is made when something first asks for it: a way of straight legs never does.
class PileSpace {
 public:
  // The geometry must outlive it.
  PileSpace(const PileGeometry& geometry, const TrajectorySpec& spec, int threads,
            FlightProgress progress);

  const VoidMap& map() const;  // robots: of the voids that the flight names, maybe none

 private:
  VoidMap make() const;

  const PileGeometry& geometry_;
  std::vector<double> robots_;  // radii of the voids that are named; unit: m
  VoidSpaceOptions options_;
  FlightProgress progress_;
  mutable std::optional<VoidMap> map_;
};

struct ResolvedVoid {
  int waypoint = 0;  // 1-based
  double radius = 0, volume = 0, way_in = 0;  // unit: m, m3, m
  Vec3 position;                              // what the place became; unit: m
};

// Puts numbers in the place of every void that waypoints name. Throws InputError when a pile has no
// such void, saying how many there are.
std::vector<ResolvedVoid> resolve_places(const PileSpace& space, TrajectorySpec& spec);

}  // namespace rubble
