#include "app/flight.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/flight_path.h"
#include "app/void_places.h"

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

std::string seconds(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f s", value);
  return text;
}

}  // namespace

FlightPlan resolve_flight(const Scenario& scenario, const AssetLibrary& assets, const PileState& pile,
                   int threads, const FlightProgress& progress) {
  FlightPlan flight;
  flight.trajectory = scenario.trajectory;
  TrajectorySpec& spec = flight.trajectory;
  Json report = Json::object();
  if (spec.needs_pile()) {
    const PileGeometry geometry(assets, pile);
    const PileSpace space(geometry, spec, threads, progress);
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
      const NearestApproach nearest = check_contact(geometry, spec, pile);
      report["least_clearance_m"] = nearest.clearance;
      report["least_clearance_at"] = json_of(nearest.position);
    }
  }
  spec.plan = Plan::ghost;  // it has been dealt with
  flight.poses = sample_trajectory(spec, scenario.start_ns);
  if (!scenario.trajectory.needs_pile() && !spec.limits.any()) return flight;

  const CameraPath trajectory(spec);
  report["duration_s"] = trajectory.duration();
  report["asked_duration_s"] = trajectory.asked_duration();
  if (trajectory.duration() > 1.001 * trajectory.asked_duration())
    flight.summary += (flight.summary.empty() ? "" : ", ") + std::string("slowed from ") +
                      seconds(trajectory.asked_duration()) + " to " +
                      seconds(trajectory.duration()) + " by its limits";
  report["waypoints"] = Json::array();
  const std::vector<double> times = waypoint_times(spec);
  for (std::size_t i = 0; i < spec.waypoints.size(); ++i)
    report["waypoints"].push_back(json_of(spec.waypoints[i], times[i]));
  flight.json = report.dump(2) + "\n";
  return flight;
}

}  // namespace rubble
