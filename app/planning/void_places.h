// The pile as a flight sees it, and the voids that a mission names.
#pragma once

#include <optional>
#include <vector>

#include "app/planning/flight.h"
#include "app/planning/pile_survey.h"

namespace rubble {

// Its free space in voxels, as fine as the smallest sphere that the flight names asks for. It takes
// seconds to make, so it is made when something first asks for it: a way of straight legs never does.
class PileSpace {
 public:
  // The survey must outlive it.
  PileSpace(PileSurvey& survey, const TrajectorySpec& spec, FlightProgress progress);

  const VoidMap& map() const;  // robots: of the voids that the flight names, and maybe others

 private:
  PileSurvey& survey_;
  std::vector<double> robots_;  // radii of the voids that are named; unit: m
  VoidSpaceOptions options_;
  mutable bool told_ = false;  // that voxels are larger than asked
  FlightProgress progress_;
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
