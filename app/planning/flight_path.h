// Ways around what lies there, and what is touched on a way that goes through.
#pragma once

#include "app/planning/void_places.h"

namespace rubble {

// Where a path comes nearest to anything solid.
struct NearestApproach {
  double clearance = 1e300;  // unit: m
  Vec3 position;             // of the camera
};

// Replaces the legs between waypoints by ways on which a sphere of spec.radius touches nothing: the
// shortest ones through the free space, their corners rounded as far as there is room. In between the
// camera looks where it goes, or at the one point that both waypoints look at. Throws InputError when there is no way, with the widest gap.
// Gives the length of all legs; unit: m
double plan_around(const PileGeometry& geometry, const PileSpace& space, TrajectorySpec& spec);

// Walks along the path. Throws InputError with the time, place and
// piece of the first contact when that is below spec.radius.
NearestApproach check_contact(const PileGeometry& geometry, const TrajectorySpec& spec,
                              const PileState& pile);

// Gives a smoothed path room: rounding its corners takes it nearer to what they go around. With the
// plan "avoid" it becomes slower there, which makes the roundings smaller; with "refuse", where times
// are the user's, it is smoothed less. Does what can be done and leaves the rest to check_contact().
// fixed: the smoothing is the user's own, and stays. Gives whether the smoothed path is free.
bool fit_smoothing(const PileGeometry& geometry, bool fixed, TrajectorySpec& spec);

}  // namespace rubble
