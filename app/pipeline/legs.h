// The legs of a recording: what the camera sees one after the other, in one sequence of frames.
//
// A mission has one leg, its flight over the settled pile. With `record_settling` another comes before
// it: the rig stands and watches the pile settle, unless nothing moved. Stamps run on from the one to the other, and inertial
// units do not pause between them. Robots, and
// the sensors on them, start with the flight.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "app/planning/flight.h"
#include "app/scene/moving_scene.h"
#include "app/sensors/build_camera.h"
#include "kernel/model/track.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

struct Leg {
  RigFlight flight;
  std::optional<TrackWindow> window;  // of the track that is shown; none: the settled pile
  std::int64_t zero_ns = 0;           // the stamp of the track's time 0
  std::uint64_t noise_seed = 0;       // of the sensors
};

// The stamp of the flight's start, and of the robots' time 0. Throws InputError as plan_legs().
std::int64_t find_flight_start(const Scenario& scenario, const Track& track);

// robots: what carries sensors. Throws InputError, keyed "record_settling.from", when the pile came to rest before.
std::vector<Leg> plan_legs(const Scenario& scenario, const FlightPlan& plan, const Track& track,
                           const RobotReadings& robots);

}  // namespace rubble
