// The camera's flight over a settled pile: from the trajectory that a mission asks for to the poses
// that are flown.
//
// Places in voids get their numbers; with the plan "avoid" every leg becomes a way around all that
// lies there; with "refuse" the path is walked ahead. What comes out follows from the scenario and
// the pile alone, and flight.json holds it.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/planning/pile_survey.h"
#include "kernel/base/system/disk_cache.h"
#include "scripting/scenario/scenario.h"
#include "scripting/trajectory/trajectory.h"

namespace rubble {

struct FlightPlan {
  TrajectorySpec trajectory;               // without places in voids, every leg straight or curved as flown
  std::shared_ptr<const CameraPath> path;  // of that trajectory, at any time
  std::vector<CameraPose> poses;           // of the frames at the trajectory's own rate
  std::string summary;                     // a few words for the person who waits
  std::string json;                        // flight.json; empty when nothing had to be resolved
};

// done: 0 to 1, of what takes long.
using FlightProgress = std::function<void(double done, const std::string& what)>;

// Throws InputError, keyed by the waypoint or "trajectory.plan": no such void, no way (and where it
// is narrowest), or the time and place of the first contact.
// cache: of ways that were planned before (flight_cache.h); none by default.
FlightPlan resolve_flight(const Scenario& scenario, PileSurvey& survey,
                          const FlightProgress& progress = {}, const DiskCache& cache = DiskCache{});

}  // namespace rubble
