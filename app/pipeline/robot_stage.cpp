// The stage from a settled pile to robots that were driven through it.
#include <algorithm>
#include <cstdio>
#include <memory>

#include "app/control/robot_control.h"
#include "app/pipeline/stages.h"
#include "app/robots/link_sensors.h"
#include "app/robots/robot_files.h"
#include "app/session/session.h"
#include "app/support/stop.h"

namespace rubble {
namespace {

void add_robot_metrics(const DrivenRobots& driven, const std::vector<RobotLog>& logs, Metrics& metrics) {
  double slip = 0;
  for (const RobotLog& log : logs) slip = std::max(slip, log.mean_slip());
  double distance = 0, path = 0, work = 0, stuck = 0, lost = 0;
  double lowest = driven.summaries.front().lowest;
  for (const RobotSummary& robot : driven.summaries) {
    distance += robot.distance;
    path += robot.path;
    work += robot.work;
    stuck += robot.stuck_time;
    lost += robot.lost;
    lowest = std::min(lowest, robot.lowest);
  }
  metrics["robot_distance_m"] = distance;
  metrics["robot_path_m"] = path;
  metrics["robot_work_j"] = work;
  metrics["robot_stuck_s"] = stuck;
  metrics["robot_lowest_m"] = lowest;
  metrics["robot_slip"] = slip;
  metrics["robots_lost"] = lost;
  metrics["robot_pieces_moved"] = driven.pieces_moved;
}

// What rides on it gives no more.
void note_lost_robots(const DrivenRobots& driven, const std::vector<std::string>& names, RunContext& context) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!driven.summaries[i].lost) continue;
    const std::vector<RobotSample>& samples = driven.readings.samples[i];
    char when[32] = "";
    if (!samples.empty())
      std::snprintf(when, sizeof when, " after %.1f s", 1e-9 * double(samples.back().stamp_ns - samples.front().stamp_ns));
    context.warnings.push_back("robot " + names[i] + " was lost" + when +
                               ": it left the world by settle.lost_below or settle.lost_beyond; what it and the sensors "
                               "on it record ends there");
  }
}

}  // namespace

DrivenRobots drive_robots(const ResolvedMission& mission, const SettledPile& pile, RunFolder& folder,
                          RunContext& context) {
  if (mission.scenario.robots.empty()) return {};
  context.progress.start("robots");
  SessionOptions options;
  options.recorded = true;
  const auto session = with_lines_of_script(mission, [&] {
    options.start_ns = find_flight_start(mission.scenario, pile.track);
    return std::make_unique<Session>(mission, pile.state, make_robots(mission, context), context, options);
  });
  const std::vector<std::string>& names = session->names();
  std::vector<RobotModel> models;
  for (const MissionRobot& robot : session->robots()) models.push_back(robot.model);
  folder.expect(robot_file_names(names, models));
  DrivenRobots driven = with_lines_of_script(mission, [&] {
    for (const std::string& warning : find_buried_sensors(mission.scenario, session->robots())) context.warnings.push_back(warning);
    session->start();
    for (std::int64_t steps = session->steps_of_mission(), i = 1; i <= steps && !stop_requested(); ++i) {
      session->step();
      char time[32];
      std::snprintf(time, sizeof time, "%.1f s", double(i) * session->step_time());
      context.progress.update(double(i) / double(steps), time);
    }
    throw_if_stopped(folder.path());
    return session->finish();
  });
  write_robot_files(folder.path(), names, driven.moved, driven.summaries, driven.pieces_moved, session->logs(),
                    driven.start_ns);
  for (const std::string& name : robot_file_names(names, models)) folder.add(name);
  add_robot_metrics(driven, session->logs(), driven.metrics);
  note_lost_robots(driven, names, context);
  context.progress.finish(std::to_string(names.size()) + " driven, " + std::to_string(driven.pieces_moved) +
                          " pieces moved");
  return driven;
}

}  // namespace rubble
