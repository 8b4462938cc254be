#include "app/pipeline/legs.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/hash.h"
#include "scripting/trajectory/sample_path.h"
#include "scripting/values/value.h"

namespace rubble {
namespace {

std::int64_t to_ns(double seconds) { return std::llround(seconds * 1e9); }

// Where the camera stands: as the mission says, or as its flight begins.
Waypoint standing_place(const RecordSettlingScenario& asked, const TrajectorySpec& flown) {
  Waypoint place;
  if (asked.position) {
    place.position = *asked.position;
    place.look_at = *asked.look_at;
    return place;
  }
  const Waypoint& first = flown.waypoints.front();
  place.position = first.position;
  place.look_at = first.look_at;
  place.rpy_deg = first.rpy_deg;
  return place;
}

double rate_of_watching(const Scenario& scenario) {
  return scenario.record_settling.rate_hz.value_or(scenario.trajectory.rate_hz);
}

Leg plan_watching(const Scenario& scenario, const TrajectorySpec& flown, const Track& track) {
  const RecordSettlingScenario& asked = scenario.record_settling;
  const double to = std::min(asked.to.value_or(track.end()), track.end());
  if (to <= asked.from) {
    throw InputError({"", 0, "record_settling.from", "the pile rests by then",
                      "less than " + format_number(track.end()) + " s", format_number(asked.from),
                      ""});
  }
  Leg leg;
  TrajectorySpec path;
  path.rate_hz = rate_of_watching(scenario);
  path.waypoints.assign(2, standing_place(asked, flown));
  path.waypoints[0].t = 0;
  path.waypoints[1].t = to - asked.from;
  leg.flight = build_rig_flight(scenario.cameras, scenario.start_ns + to_ns(asked.from), path.rate_hz,
                                std::make_shared<const CameraPath>(path));
  leg.window = TrackWindow{asked.from, to};
  leg.zero_ns = scenario.start_ns;
  leg.noise_seed = hash64("settling") ^ scenario.seed;
  return leg;
}

// The first stamp after the watching at which a frame of either rate may come.
std::int64_t end_of(const Leg& watching, double rate_hz, const Track& track) {
  const std::int64_t next =
      sample_path(*watching.flight.path, rate_hz, watching.flight.start_ns).back().stamp_ns + to_ns(1 / rate_hz);
  return std::max(next, watching.zero_ns + to_ns(track.end()));
}

}  // namespace

std::vector<Leg> plan_legs(const Scenario& scenario, const FlightPlan& plan, const Track& track,
                           const RobotReadings& robots) {
  std::vector<Leg> legs;
  Leg flight;
  flight.noise_seed = scenario.seed;
  std::int64_t start_ns = scenario.start_ns;
  if (scenario.record_settling.on && track.end() > 0) {
    legs.push_back(plan_watching(scenario, plan.trajectory, track));
    start_ns = end_of(legs.front(), rate_of_watching(scenario), track);
  }
  const std::shared_ptr<const MotionPath> path = robots.ride ? robots.ride : plan.path;
  flight.flight = build_rig_flight(scenario.cameras, start_ns, scenario.trajectory.rate_hz, path, robots);
  legs.push_back(std::move(flight));
  return legs;
}

}  // namespace rubble
