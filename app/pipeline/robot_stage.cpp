// The stage from a settled pile to robots that were driven through it.
#include <algorithm>

#include "app/pipeline/robot_control.h"
#include "app/pipeline/robot_files.h"
#include "app/pipeline/stages.h"
#include "app/support/stop.h"
#include "kernel/robot/robot_run.h"
#include "scripting/sandbox/script_file.h"
#include "scripting/sandbox/source_map.h"
#include "scripting/values/value.h"

namespace rubble {
namespace {

RobotRunOptions run_options(const Scenario& scenario, int threads) {
  RobotRunOptions options;
  options.duration = scenario.robot_run.duration;
  options.control_hz = scenario.robot_run.control_hz;
  options.fixed_debris = scenario.robot_run.debris == DebrisMotion::fixed;
  options.gravity = scenario.settle.gravity;
  options.lost_below = scenario.settle.lost_below;
  options.lost_beyond = scenario.settle.lost_beyond;
  options.threads = threads;
  return options;
}

void add_robot_metrics(const RobotRunResult& result, Metrics& metrics) {
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
  metrics["robots_lost"] = lost;
  metrics["robot_pieces_moved"] = result.pieces_moved;
}

// A mistake that shows only in the pile, with the line of its key.
void add_lines(const ResolvedMission& mission, std::vector<Diagnostic>& mistakes) {
  const SourceFile& script = mission.provenance.script;
  if (std::any_of(mistakes.begin(), mistakes.end(), [](const Diagnostic& d) { return d.line > 0; })) {
    return;
  }
  locate(mistakes, script.path, SourceMap(script.text, "mission"));
}

}  // namespace

DrivenRobots drive_robots(const ResolvedMission& mission, const PileState& pile, RunFolder& folder,
                          RunContext& context) {
  DrivenRobots driven;
  const std::vector<RobotItem>& robots = mission.scenario.robots;
  if (robots.empty()) return driven;
  context.progress.start("robots");
  const std::vector<std::string> names = robot_names(robots);
  folder.expect(robot_file_names(names));
  std::unique_ptr<ScriptControl> script;
  std::vector<JointLog> logs(robots.size());
  for (const RobotItem& robot : robots) driven.moved.models.push_back(make_robot_model(robot));
  RobotRunResult result;
  try {
    RobotRun run(make_pile(mission), pile, run_options(mission.scenario, context.threads()));
    for (std::size_t i = 0; i < robots.size(); ++i) {
      const RobotModel& model = driven.moved.models[i];
      RobotController control;
      if (robots[i].control > 0) {
        if (!script) script = std::make_unique<ScriptControl>(mission);
        control = script->controller_of(i, model);
      } else {
        control = make_leg_controller(robots[i], model);
      }
      run.add(model, calc_base_pose(robots[i]), [control, &log = logs[i]](const RobotSense& sense) mutable {
        log.times.push_back(sense.time);
        log.joints.push_back(sense.state.joints);
        return control(sense);
      });
    }
    result = run.run([&](double done) {
      context.progress.update(done, format_number(done * mission.scenario.robot_run.duration) + " s");
      return !stop_requested();
    });
  } catch (const InputError& error) {
    std::vector<Diagnostic> mistakes = error.diagnostics();
    add_lines(mission, mistakes);
    throw InputError(std::move(mistakes));
  }
  throw_if_stopped(folder.path());
  write_robot_files(folder.path(), names, driven.moved.models, result, logs,
                    mission.scenario.start_ns);
  for (const std::string& name : robot_file_names(names)) folder.add(name);
  add_robot_metrics(result, driven.metrics);
  driven.moved.track = std::move(result.track);
  driven.moved.first_piece = std::move(result.first_piece);
  context.progress.finish(std::to_string(robots.size()) + " driven, " +
                          std::to_string(result.pieces_moved) + " pieces moved");
  return driven;
}

}  // namespace rubble
