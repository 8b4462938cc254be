#include "app/pipeline/legs.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/hash.h"
#include "kernel/base/number_text.h"
#include "scripting/trajectory/trajectory.h"
#include "scripting/values/value.h"

namespace rubble {
namespace {

constexpr double kBeforeFlight = 1e-5;  // the watching ends so long before; unit: s

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

// What of the track is recorded; nothing: none is.
std::optional<TrackWindow> find_window(const Scenario& scenario, const Track& track) {
  const RecordSettlingScenario& asked = scenario.record_settling;
  if (!asked.on || track.end() <= 0) return std::nullopt;
  const double to = std::min(asked.to.value_or(track.end()), track.end());
  if (to <= asked.from) {
    throw InputError({"", 0, "record_settling.from", "the pile rests by then",
                      "less than " + exact_text(track.end()) + " s", exact_text(asked.from),
                      ""});
  }
  return TrackWindow{asked.from, to};
}

// Standing there as long as that.
TrajectorySpec stand(const Waypoint& place, const TrackWindow& window, double rate_hz) {
  TrajectorySpec path;
  path.rate_hz = rate_hz;
  path.waypoints.assign(2, place);
  path.waypoints[0].t = 0;
  path.waypoints[1].t = window.to - window.from;
  return path;
}

// Of what stands on the rig: robots, and what they carry, come with the flight.
Leg plan_watching(const Scenario& scenario, const TrajectorySpec& flown, const TrackWindow& window, std::int64_t flight_ns) {
  Leg leg;
  TrajectorySpec path = stand(standing_place(scenario.record_settling, flown), window, rate_of_watching(scenario));
  const std::int64_t start_ns = scenario.start_ns + to_ns(window.from);
  leg.flight = build_rig_flight(scenario.cameras, start_ns, path.rate_hz, std::make_shared<const CameraPath>(path));
  path.waypoints.back().t = double(flight_ns - start_ns) * 1e-9 - kBeforeFlight;
  leg.flight.path = std::make_shared<const CameraPath>(path);
  leg.window = window;
  leg.zero_ns = scenario.start_ns;
  leg.noise_seed = hash64("settling") ^ scenario.seed;
  return leg;
}

}  // namespace

// The first stamp at the rate of the watching when it is over and all rests: what measures at a multiple of that rate
// goes on without a jump.
std::int64_t find_flight_start(const Scenario& scenario, const Track& track) {
  const std::optional<TrackWindow> window = find_window(scenario, track);
  if (!window) return scenario.start_ns;
  const double rate_hz = rate_of_watching(scenario);
  const CameraPath path(stand({}, *window, rate_hz));
  const std::int64_t begin = scenario.start_ns + to_ns(window->from), rest = scenario.start_ns + to_ns(track.end());
  std::int64_t frames = std::int64_t(sample_path(path, rate_hz, begin).size());
  frames = std::max(frames, std::int64_t(std::ceil(double(rest - begin) * 1e-9 * rate_hz - 1e-6)));
  return begin + to_ns(double(frames) / rate_hz);
}

std::vector<Leg> plan_legs(const Scenario& scenario, const FlightPlan& plan, const Track& track,
                           const RobotReadings& robots) {
  std::vector<Leg> legs;
  const std::int64_t flight_ns = find_flight_start(scenario, track);
  if (const auto window = find_window(scenario, track))
    legs.push_back(plan_watching(scenario, plan.trajectory, *window, flight_ns));
  Leg flight;
  flight.noise_seed = scenario.seed;
  const std::shared_ptr<const MotionPath> path = robots.ride ? robots.ride : plan.path;
  flight.flight = build_rig_flight(scenario.cameras, flight_ns, scenario.trajectory.rate_hz, path, robots);
  legs.push_back(std::move(flight));
  return legs;
}

}  // namespace rubble
