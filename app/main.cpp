// The command line: parses, calls one command, turns errors into messages and exit codes.
#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>

#include "app/build_info.h"
#include "app/commands.h"

namespace rubble {
namespace {

void add_mission_options(CLI::App& command, RunRequest& request) {
  command.add_option("mission", request.mission, "The mission, a Lua script")->required();
  command.add_option("--seed", request.seed, "Seed of all randomness; overrides the script's");
  command.add_option("--set", request.overrides, "Override a key of the mission: key=value")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false)
      ->take_all();
  command.add_option("--assets", request.asset_packs, "A further folder with a pack.lua")
      ->type_name("DIR")
      ->allow_extra_args(false)
      ->take_all();
}

void add_output_options(CLI::App& command, RunRequest& request) {
  command.add_option("--out", request.out, "Output folder (default: out/<name of the script>)")
      ->type_name("DIR");
  command.add_flag("--force", request.force, "Replace the files of an earlier run");
  command.add_option("--threads", request.threads,
                     "Threads to use; 0: all processors. Results do not depend on it")
      ->check(CLI::Range(0, 256));
  command.add_flag("--quiet", request.quiet, "No progress, only errors");
}

ExitCode run(int argc, char** argv) {
  CLI::App app{"Simulates collapsed structures: a seed and a Lua mission give a settled pile, a "
               "camera flight, RGB-D frames, an MRPT rawlog, a ROS bag and the ground truth."};
  app.footer("Exit codes: 0 done, 1 bad input, 2 failure, 3 finished but did not settle.");
  app.set_version_flag("--version", "rubble " + build_info().version);
  app.require_subcommand(1);

  RunRequest request;
  CLI::App* run = app.add_subcommand("run", "Run a mission to a finished dataset");
  CLI::App* settle = app.add_subcommand("settle", "Settle the pile of a mission, nothing more");
  CLI::App* check = app.add_subcommand("check", "Print the complete scenario as JSON; run nothing");
  CLI::App* info = app.add_subcommand("info", "Print versions, the GL renderer and threads");
  for (CLI::App* command : {run, settle, check}) add_mission_options(*command, request);
  for (CLI::App* command : {run, settle}) add_output_options(*command, request);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? ExitCode::done : ExitCode::bad_input;
  }
  if (*run) return run_mission(request);
  if (*settle) return settle_mission(request);
  if (*check) return check_mission(request);
  if (*info) return print_info();
  return ExitCode::bad_input;
}

}  // namespace
}  // namespace rubble

int main(int argc, char** argv) {
  using rubble::ExitCode;
  std::signal(SIGXFSZ, SIG_IGN);  // a file-size limit is then an error of write(), like a full disk
  try {
    return int(rubble::run(argc, argv));
  } catch (const rubble::InputError& error) {
    std::fprintf(stderr, "\n%s\n", error.what());
    return int(ExitCode::bad_input);
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "\nrubble: out of memory\n");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "\nrubble: %s\n", error.what());
  }
  return int(ExitCode::failure);
}
