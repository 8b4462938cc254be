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
Waypoint standing_place(const Scenario& flown) {
  Waypoint place;
  const RecordSettlingScenario& asked = flown.record_settling;
  if (asked.position) {
    place.position = *asked.position;
    place.look_at = *asked.look_at;
    return place;
  }
  const Waypoint& first = flown.trajectory.waypoints.front();
  place.position = first.position;
  place.look_at = first.look_at;
  place.rpy_deg = first.rpy_deg;
  return place;
}

Leg plan_watching(const Scenario& flown, const Track& track) {
  const RecordSettlingScenario& asked = flown.record_settling;
  const double to = std::min(asked.to.value_or(track.end()), track.end());
  if (to <= asked.from) {
    throw InputError({"", 0, "record_settling.from", "the pile rests by then",
                      "less than " + format_number(track.end()) + " s", format_number(asked.from),
                      ""});
  }
  Leg leg;
  leg.scenario = flown;
  leg.scenario.start_ns = flown.start_ns + to_ns(asked.from);
  TrajectorySpec path;
  path.rate_hz = asked.rate_hz.value_or(flown.trajectory.rate_hz);
  path.waypoints.assign(2, standing_place(flown));
  path.waypoints[0].t = 0;
  path.waypoints[1].t = to - asked.from;
  leg.scenario.trajectory = path;
  leg.flight = build_rig_flight(leg.scenario, std::make_shared<const CameraPath>(path));
  leg.window = TrackWindow{asked.from, to};
  leg.zero_ns = flown.start_ns;
  leg.noise_seed = hash64("settling") ^ flown.seed;
  return leg;
}

// The first stamp after the watching at which a frame of either rate may come.
std::int64_t end_of(const Leg& watching, const Track& track) {
  const double rate_hz = watching.scenario.trajectory.rate_hz;
  const std::int64_t next =
      sample_path(*watching.flight.path, rate_hz, watching.scenario.start_ns).back().stamp_ns +
      to_ns(1 / rate_hz);
  return std::max(next, watching.zero_ns + to_ns(track.end()));
}

}  // namespace

std::vector<Leg> plan_legs(const Scenario& flown, std::shared_ptr<const MotionPath> path,
                           const Track& track, const RobotReadings& robots) {
  std::vector<Leg> legs;
  Leg flight;
  flight.scenario = flown;
  flight.noise_seed = flown.seed;
  if (flown.record_settling.on && track.end() > 0) {
    legs.push_back(plan_watching(flown, track));
    flight.scenario.start_ns = end_of(legs.front(), track);
  }
  flight.flight = build_rig_flight(flight.scenario, std::move(path), robots);
  legs.push_back(std::move(flight));
  return legs;
}

}  // namespace rubble
