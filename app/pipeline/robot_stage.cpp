// The stage from a settled pile to robots that were driven through it.
#include <algorithm>
#include <cstdio>

#include "app/control/robot_control.h"
#include "app/control/robot_senses.h"
#include "app/control/script_control.h"
#include "app/pipeline/stages.h"
#include "app/robots/buried_sensors.h"
#include "app/robots/felt_links.h"
#include "app/robots/mission_robot.h"
#include "app/robots/ride_recorder.h"
#include "app/robots/robot_files.h"
#include "app/support/stop.h"
#include "kernel/robot/robot_run.h"
#include "scripting/sandbox/script_file.h"
#include "scripting/sandbox/source_map.h"
#include "scripting/values/value.h"

namespace rubble {
namespace {

void add_robot_metrics(const RobotRunResult& result, const std::vector<RobotLog>& logs,
                       Metrics& metrics) {
  double slip = 0;
  for (const RobotLog& log : logs) slip = std::max(slip, log.mean_slip());
  double distance = 0, path = 0, work = 0, stuck = 0, lost = 0;
  double lowest = result.robots.front().lowest;
  for (const RobotSummary& robot : result.robots) {
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
  metrics["robot_pieces_moved"] = result.pieces_moved;
}

// Its links have no place any more, but what rides on it goes on measuring where it was last.
void note_lost_robots(const RobotRunResult& result, const std::vector<std::string>& names,
                      const std::vector<RobotLog>& logs, RunContext& context) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!result.robots[i].lost) continue;
    const std::vector<RobotSample>& samples = logs[i].samples();
    char when[32] = "";
    if (!samples.empty())
      std::snprintf(when, sizeof when, " after %.1f s", 1e-9 * double(samples.back().stamp_ns - samples.front().stamp_ns));
    context.warnings.push_back("robot " + names[i] + " was lost" + when +
                               ": it left the world by settle.lost_below or settle.lost_beyond; what its sensors record "
                               "after that is from where it was last");
  }
}

// The controller of each robot: legs, or a function of the script.
RobotController make_controller(const ResolvedMission& mission, std::size_t robot,
                                const MissionRobot& made, RobotSenses& senses,
                                std::unique_ptr<ScriptControl>& script) {
  const RobotItem& item = mission.scenario.robots[robot];
  if (item.control == 0) return with_mimics(make_leg_controller(item, made.model), made.model.mimics);
  if (!script) script = std::make_unique<ScriptControl>(mission, senses);
  return with_mimics(script->controller_of(robot, made.model), made.model.mimics);
}

}  // namespace

DrivenRobots drive_robots(const ResolvedMission& mission, const PileState& pile, RunFolder& folder,
                          RunContext& context) {
  DrivenRobots driven;
  const std::vector<RobotItem>& robots = mission.scenario.robots;
  if (robots.empty()) return driven;
  context.progress.start("robots");
  const std::vector<std::string> names = robot_names(robots);
  std::vector<RobotModel>& models = driven.moved.models;
  const std::vector<MissionRobot> made = with_lines_of_script(mission, [&] { return make_robots(mission, context); });
  for (const MissionRobot& robot : made) models.push_back(robot.model);
  folder.expect(robot_file_names(names, models));
  std::unique_ptr<ScriptControl> script;
  std::vector<RobotLog> logs;
  for (std::size_t i = 0; i < robots.size(); ++i)
    logs.emplace_back(models[i], mission.scenario.start_ns, odometry_noise(mission.scenario, i));
  driven.records = with_lines_of_script(mission, [&] { return describe_robots(mission.scenario, made); });
  RobotRunResult result;
  with_lines_of_script(mission, [&] {
    RideRecorder rides(mission.scenario, made);
    RobotSenses senses(mission, pile, made, context);
    const RobotRunOptions options = robot_run_options(mission.scenario, context.threads());
    RobotRun run(make_laid_pile(mission, pile), pile, options);
    for (std::size_t i = 0; i < robots.size(); ++i) {
      const RobotController control = make_controller(mission, i, made[i], senses, script);
      run.add(models[i], calc_base_pose(robots[i], made[i]), [control, &log = logs[i]](const RobotSense& sense) {
        log.note(sense);
        return control(sense);
      });
    }
    rides.note(run.world());
    ContactHistory contacts(options.step);
    for (const std::string& warning : find_buried_sensors(mission.scenario, made)) context.warnings.push_back(warning);
    driven.readings.felt = find_felt_links(mission.scenario, made);
    senses.begin(run, options.step);
    result = run.run([&](double done) {
      rides.note(run.world());
      if (!mission.scenario.sensors.empty()) contacts.note(run.world(), int(robots.size()));
      senses.note_step(run.world());
      char time[32];
      std::snprintf(time, sizeof time, "%.1f s", done * mission.scenario.robot_run.duration);
      context.progress.update(done, time);
      return !stop_requested();
    });
    throw_if_stopped(folder.path());
    for (std::size_t i = 0; i < robots.size(); ++i) {
      const RobotSense last{run.world().time(), run.world().robot_state(int(i)), run.world().robot_contacts(int(i))};
      if (!last.state.lost) logs[i].note(last);
    }
    driven.readings.contacts = std::move(contacts);
    driven.mount = rides.finish(options.step, driven.records, driven.readings);
    return true;
  });
  write_robot_files(folder.path(), names, models, result, logs, mission.scenario.start_ns);
  for (const std::string& name : robot_file_names(names, models)) folder.add(name);
  add_robot_metrics(result, logs, driven.metrics);
  note_lost_robots(result, names, logs, context);
  for (const RobotLog& log : logs) driven.readings.samples.push_back(log.samples());
  driven.moved.track = std::move(result.track);
  driven.moved.first_piece = std::move(result.first_piece);
  context.progress.finish(std::to_string(robots.size()) + " driven, " +
                          std::to_string(result.pieces_moved) + " pieces moved");
  return driven;
}

}  // namespace rubble
