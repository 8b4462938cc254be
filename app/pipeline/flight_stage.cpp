// The stages that ask where a settled pile has room: the measures of its voids, and the flight.
#include <cstdio>

#include "app/measures/metrics.h"
#include "app/pipeline/stages.h"
#include "app/planning/flight.h"
#include "app/planning/solid_matter.h"
#include "app/support/stop.h"
#include "io/base/atomic_file.h"
#include "scripting/sandbox/script_file.h"
#include "scripting/values/value.h"

namespace rubble {
namespace {

// With what the trajectory depends on besides the script: places in voids, ways around the pile.
// flight.json holds it.
FlightPlan resolve(const ResolvedMission& mission, PileSurvey& survey, RunFolder& folder,
                   RunContext& context) {
  const bool quick = !mission.scenario.trajectory.needs_pile();
  if (!quick) context.progress.start("flight");
  const FlightPlan plan = with_lines_of_script(mission, [&] {
    return resolve_flight(mission.scenario, survey, [&](double done, const std::string& what) {
      throw_if_stopped(folder.path());
      context.progress.update(done, what);
    }, DiskCache(DiskCache::usual_folder()));
  });
  if (!quick) context.progress.finish(plan.summary.empty() ? "planned" : plan.summary);
  if (!plan.json.empty()) {
    write_text_file(folder.file("flight.json"), plan.json);
    folder.add("flight.json");
  }
  return plan;
}

void warn_of_sensors_inside(const ResolvedMission& mission, const RigFlight& flight, const PileState& pile,
                            const RobotReadings& robots, RunContext& context) {
  const SolidMatter solid(mission.assets, pile);
  const bool rig_rides = mission.scenario.trajectory.ride.on();
  const auto look = [&](const std::string& who, const std::vector<Vec3>& positions, const Carrier& carrier) {
    if (const auto warning = solid.warn_of(who, positions, rig_rides || carrier.on())) context.warnings.push_back(*warning);
  };
  const std::vector<MountedCamera>& cameras = mission.scenario.cameras;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    std::vector<Vec3> positions;
    for (const Pose& pose : flight.cameras[i].world_from_camera) positions.push_back(pose.translation);
    look(cameras[i].named ? "camera `" + cameras[i].name + "`: the camera" : "the camera", positions, cameras[i].ride);
  }
  if (flight.cameras.empty() || flight.cameras.front().stamps_ns.empty()) return;
  const std::vector<std::int64_t>& stamps = flight.cameras.front().stamps_ns;
  for (const SensorItem& sensor : mission.scenario.sensors) {
    const auto& way = robots.path_of(sensor.ride, flight.path);
    if (!sensor.figures->casts_rays() || !way) continue;
    const std::int64_t end = robots.end_of(sensor.ride, flight.path, flight.start_ns, stamps.back());
    std::vector<Vec3> positions;
    for (const std::int64_t stamp : stamps)
      if (stamp <= end) positions.push_back(way->at(double(stamp - flight.start_ns) * 1e-9) * sensor.position);
    look(sensor.key(), positions, sensor.ride);
  }
}

}  // namespace

Metrics measure_voids(const ResolvedMission& mission, PileSurvey& survey, const RunFolder& folder,
                      RunContext& context) {
  Metrics metrics;
  const VoidScenario& asked = mission.scenario.voids;
  if (!asked.on) return metrics;
  context.progress.start("voids");
  const auto report = [&](double done) {
    context.progress.update(done, "free space");
    throw_if_stopped(folder.path());
    return true;
  };
  add_void_metrics(survey.find_voids(make_void_options(asked), {asked.radius}, report), asked.radius,
                   metrics);
  if (!mission.scenario.trajectory.needs_pile()) survey.forget_voids();
  char volume[48];
  std::snprintf(volume, sizeof volume, "%.4g m3", metrics["void_volume_m3"]);
  context.progress.finish(volume);
  return metrics;
}

std::vector<Leg> plan_flight(const ResolvedMission& mission, const SettledPile& pile,
                          const DrivenRobots& robots, PileSurvey& survey, RunFolder& folder, RunContext& context) {
  const FlightPlan plan = resolve(mission, survey, folder, context);
  survey.forget_voids();
  std::vector<Leg> legs = with_lines_of_script(
      mission, [&] { return plan_legs(mission.scenario, plan, pile.track, robots.readings); });
  if (mission.scenario.record_settling.on && legs.size() == 1)
    context.warnings.push_back("record_settling: the pile rests from the start: there is no settling to record");
  warn_of_sensors_inside(mission, legs.back().flight, pile.state, robots.readings, context);
  return legs;
}

}  // namespace rubble
