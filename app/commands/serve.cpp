// `rubble serve`: the robots of a mission, live over ROS 2, for programs that drive them and the simulation.
#include <memory>

#include "app/command_line/command.h"
#include "app/command_line/common_options.h"
#include "app/pipeline/live.h"
#include "app/pipeline/stages.h"
#include "app/serve/simulation_server.h"
#include "app/support/print.h"
#include "app/support/stop.h"
#include "io/live/live_ros.h"

namespace rubble {
namespace {

struct ServeRequest {
  RunRequest run;
  bool paused = false;   // --paused
  double duration = 0;   // --duration: of simulation time; unit: s; 0: no end
};

ExitCode serve(const ServeRequest& request) {
  stop_on_signals();
  check_live(request.run.options);
  RunContext context(request.run.options);
  ResolvedMission mission = resolve_mission(request.run, RunKind::run, context);
  if (mission.scenario.robots.empty())
    throw with_lines(mission, InputError({"", 0, "robots", "the mission has no robot to serve", "at least one robot", "none",
                                          "`rubble run --ros2` publishes the flight of a camera"}));
  PileState pile = settle_in_memory(mission, context, [] { return !stop_requested(); }).state;
  const auto server = make_live_server(request.run.options);
  const ResolvedMission script = mission;
  const auto world = with_lines_of_script(
      script, [&] { return std::make_unique<ServedWorld>(std::move(mission), std::move(pile), context); });
  if (!script.scenario.cameras.empty() && script.scenario.names_cameras())
    print_err("serve: cameras are left out; `rubble run --ros2` and `rubble drive --ros2` publish pictures\n");
  SimulationServer simulation(*world, *server, request.paused,
                              [](const std::string& line) { print_err("\nrubble: %s\n", line.c_str()); });
  print_err("serving %zu robots and %zu pieces\n", world->session().names().size(),
            world->entities().size() - world->session().names().size());
  simulation.run(request.duration);
  server->finish();
  return ExitCode::done;
}

Action declare_serve(CommandLine& line) {
  const auto request = std::make_shared<ServeRequest>();
  request->run.options.live.ros2 = true;
  add_mission_options(line, request->run);
  add_seed_option(line, request->run);
  add_served_options(line, request->run.options.live);
  line.add_flag("--paused", request->paused, "Begin paused; /set_simulation_state and /step_simulation go on");
  line.add("--duration", request->duration, "End after so much simulation time").shows_default_text("none").metavar("SECONDS").positive();
  add_threads_option(line, request->run.options.threads);
  add_quiet_option(line, request->run.options.quiet);
  return [request] { return serve(*request); };
}

}  // namespace

Command serve_command() {
  return {"", "serve", "Serve the robots of a mission live over ROS 2: topics, commands and simulation_interfaces", declare_serve};
}

}  // namespace rubble
