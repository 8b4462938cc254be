#include "app/planning/flight.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/planning/flight_path.h"
#include "app/planning/void_places.h"
#include "scripting/trajectory/trajectory.h"

namespace rubble {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Vec3& v) { return Json::array({v.x, v.y, v.z}); }

Json json_of(const Waypoint& w, double t) {
  Json json = {{"t", t}, {"position", json_of(w.position)}};
  if (w.look_at) json["look_at"] = json_of(*w.look_at);
  json["rpy_deg"] = json_of(w.rpy_deg);
  return json;
}

// Without its smoothing the path has room, with it it has none.
[[noreturn]] void refuse_smoothing(const Scenario& scenario) {
  const bool inertial = scenario.has_unit_on_rig() && !scenario.trajectory.smoothing;
  const std::string unit = !inertial ? "" : scenario.imus.front().named ? "imus" : "imu.on";
  throw InputError({"", 0, inertial ? unit : "trajectory.smoothing",
                    "the path cannot be smoothed within the available clearance",
                    "clearance to round its corners", "none",
                    inertial ? "an IMU needs a path without corners: fly slower, make "
                               "trajectory.radius smaller, use plan = \"avoid\", or switch the unit off"
                             : "fly slower, or smooth less"});
}

// Rounds the corners within the room that is there.
void smooth_within_room(const Scenario& scenario, const PileGeometry& geometry,
                        const PileState& pile, TrajectorySpec& spec) {
  if (!spec.smoothing) spec.smoothing = CameraPath(spec).smoothing();
  if (*spec.smoothing <= 0 || spec.waypoints.size() < 2) return;
  if (fit_smoothing(geometry, scenario.trajectory.smoothing.has_value(), spec)) return;
  TrajectorySpec sharp = spec;
  sharp.smoothing = 0, sharp.rest_at_ends = false, sharp.limits.max_jerk.reset();
  check_contact(geometry, sharp, pile);  // if that touches something, too, it says what
  refuse_smoothing(scenario);
}

std::string seconds(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f s", value);
  return text;
}

}  // namespace

FlightPlan resolve_flight(const Scenario& scenario, PileSurvey& survey,
                          const FlightProgress& progress) {
  FlightPlan flight;
  flight.trajectory = flown_trajectory(scenario);
  TrajectorySpec& spec = flight.trajectory;
  Json report = Json::object();
  if (spec.needs_pile()) {
    const PileGeometry& geometry = survey.geometry();
    const PileSpace space(survey, spec, progress);
    for (const ResolvedVoid& found : resolve_places(space, spec))
      report["voids"].push_back({{"waypoint", found.waypoint},
                                 {"radius_m", found.radius},
                                 {"volume_m3", found.volume},
                                 {"way_in_m", found.way_in},
                                 {"position", json_of(found.position)}});
    if (spec.plan == Plan::avoid) {
      const double length = plan_around(geometry, space, spec);
      report["length_m"] = length;
      char text[48];
      std::snprintf(text, sizeof text, "a way of %.1f m", length);
      flight.summary = text;
    }
    if (spec.plan != Plan::ghost) {
      smooth_within_room(scenario, geometry, geometry.pile, spec);
      const NearestApproach nearest = check_contact(geometry, spec, geometry.pile);
      report["least_clearance_m"] = nearest.clearance;
      report["least_clearance_at"] = json_of(nearest.position);
    }
  }
  spec.plan = Plan::ghost;  // it has been dealt with
  flight.path = std::make_shared<const CameraPath>(spec);
  const CameraPath& trajectory = *flight.path;
  flight.poses = sample_path(trajectory, spec.rate_hz, scenario.start_ns);
  const bool changed = spec.limits.any() || trajectory.smoothing() > 0;
  if (!scenario.trajectory.needs_pile() && !changed) return flight;

  report["duration_s"] = trajectory.duration();
  report["asked_duration_s"] = trajectory.asked_duration();
  if (trajectory.duration() > 1.001 * trajectory.asked_duration())
    flight.summary += (flight.summary.empty() ? "" : ", ") + std::string("slowed from ") +
                      seconds(trajectory.asked_duration()) + " to " +
                      seconds(trajectory.duration()) + " by its limits";
  if (trajectory.smoothing() > 0) report["smoothing_s"] = trajectory.smoothing();
  report["waypoints"] = Json::array();
  const std::vector<double> times = trajectory.waypoint_times();
  for (std::size_t i = 0; i < spec.waypoints.size(); ++i)
    report["waypoints"].push_back(json_of(spec.waypoints[i], times[i]));
  flight.json = report.dump(2) + "\n";
  return flight;
}

}  // namespace rubble
