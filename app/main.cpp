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

// mission: the name of the option, without dashes: its place is that of an argument.
void add_mission_options(CLI::App& command, RunRequest& request,
                         const std::string& mission = "mission") {
  command.add_option(mission, request.mission, "The mission, a Lua script")->required();
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

void add_run_options(CLI::App& command, RunOptions& options) {
  command
      .add_option("--threads", options.threads,
                  "Threads to use; 0: all processors. Results do not depend on it")
      ->check(CLI::Range(0, 256));
  command.add_flag("--quiet", options.quiet, "No progress, only errors");
  command
      .add_option("--checkpoint-every", options.checkpoint_every,
                  "Keep a checkpoint of settling that often (default: 10 s)")
      ->type_name("SECONDS")
      ->check(CLI::Range(0.0, 1e6));
}

void add_output_options(CLI::App& command, RunRequest& request) {
  command.add_option("--out", request.out, "Output folder (default: out/<name of the script>)")
      ->type_name("DIR");
  command.add_flag("--force", request.force, "Replace the files of an earlier run");
  add_run_options(command, request.options);
}

// For commands that begin with the folder of a run.
void add_folder_options(CLI::App& command, FolderRequest& request) {
  command.add_option("folder", request.folder, "The output folder of a run")->required();
  command.add_option("--assets", request.asset_packs, "A folder where packs of the run may be now")
      ->type_name("DIR")
      ->allow_extra_args(false)
      ->take_all();
  add_run_options(command, request.options);
}

void add_verify_options(CLI::App& command, VerifyRequest& request) {
  add_folder_options(command, request.of);
  command.add_option("--work", request.work, "Where to make the run anew (default: $TMPDIR)")
      ->type_name("DIR");
  command.add_flag("--pile-only", request.pile_only, "Settle again, but render nothing");
  command.add_flag("--json", request.json, "The result as JSON");
}

void add_void_options(CLI::App& command, VoidRequest& request) {
  command
      .add_option("--radius", request.radii, "Radius of a robot (default: 0.1, 0.2 and 0.3)")
      ->type_name("METRES")
      ->allow_extra_args(false)
      ->take_all();
  command.add_option("--voxel", request.voxel, "Edge of a voxel (default: 0.02)")
      ->type_name("METRES");
  command
      .add_option("--rolling-radius", request.rolling_radius,
                  "Outside is what a ball of this radius reaches from the sky (default: 1)")
      ->type_name("METRES");
  command.add_option("--memory", request.memory_gib, "Refuse to need more (default: 4)")
      ->type_name("GIB");
  command
      .add_option("--surfaces", request.surfaces,
                  "Write the surfaces of so many voids of each radius, largest first (default: 20)")
      ->check(CLI::Range(0, 100000));
  command.add_option("--out", request.out, "Output folder (default: FOLDER/voids)")
      ->type_name("DIR");
  command.add_flag("--force", request.force, "Replace the files of an earlier map");
}

void add_trajectory_options(CLI::App& command, TrajectoryRequest& request) {
  command.add_option("estimate", request.estimate, "The estimate: a TUM or EuRoC file")->required();
  command.add_option("truth", request.truth, "The truth: a TUM or EuRoC file")->required();
  command.add_option("--delta", request.delta, "Relative errors over so many poses (default: 1)");
  command
      .add_option("--max-difference", request.max_difference,
                  "Largest difference of the stamps of a pair (default: 0.01)")
      ->type_name("SECONDS")
      ->check(CLI::NonNegativeNumber);
  command.add_flag("--json", request.json, "The result as JSON");
}

ExitCode run(int argc, char** argv) {
  CLI::App app{
      "Simulates collapsed structures: a seed and a Lua mission give a settled pile, a "
      "camera flight, RGB-D frames, an MRPT rawlog, a ROS bag and the ground truth."};
  app.footer(
      "Exit codes: 0 done, 1 bad input, 2 failure, 3 finished but did not settle, 4 stopped by "
      "a signal, 5 not the same.");
  app.set_version_flag("--version", "rubble " + build_info().version);
  app.require_subcommand(1);

  RunRequest request;
  FolderRequest of_folder;
  VerifyRequest to_verify;
  std::string from;
  CLI::App* run = app.add_subcommand("run", "Run a mission to a finished dataset");
  CLI::App* settle = app.add_subcommand("settle", "Settle the pile of a mission, nothing more");
  CLI::App* resume = app.add_subcommand("resume", "Continue a run that was stopped or killed");
  CLI::App* verify =
      app.add_subcommand("verify", "Run again from the manifest alone, and compare every hash");
  CLI::App* render =
      app.add_subcommand("render", "Another mission's flight over the pile of a finished run");
  VoidRequest void_request;
  CLI::App* voids =
      app.add_subcommand("voids", "Map the voids of a run's pile: entrances, volumes, widest ways");
  TrajectoryRequest trajectory_request;
  CLI::App* eval = app.add_subcommand("eval", "Score what others made of a dataset");
  eval->require_subcommand(1);
  CLI::App* trajectory =
      eval->add_subcommand("trajectory", "Absolute and relative errors of a trajectory, as evo's");
  add_trajectory_options(*trajectory, trajectory_request);
  CLI::App* check = app.add_subcommand("check", "Print the complete scenario as JSON; run nothing");
  CLI::App* info = app.add_subcommand("info", "Print versions, the GL renderer and threads");
  for (CLI::App* command : {run, settle, check}) add_mission_options(*command, request);
  render->add_option("folder", from, "The output folder of the run with the pile")->required();
  add_mission_options(*render, request, "--mission");
  for (CLI::App* command : {run, settle, render}) add_output_options(*command, request);
  add_verify_options(*verify, to_verify);
  for (CLI::App* command : {resume, voids}) add_folder_options(*command, of_folder);
  add_void_options(*voids, void_request);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? ExitCode::done : ExitCode::bad_input;
  }
  if (*run) return run_mission(request);
  if (*settle) return settle_mission(request);
  if (*verify) return verify_run(to_verify);
  if (*resume) return resume_run(of_folder);
  if (*render) return render_saved_pile(from, request);
  if (*voids) return map_voids(of_folder, void_request);
  if (*trajectory) return eval_trajectory(trajectory_request);
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
  } catch (const rubble::Stopped& stopped) {
    std::fprintf(stderr, "\n%s\n", stopped.what());
    return int(ExitCode::stopped);
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "\nrubble: out of memory\n");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "\nrubble: %s\n", error.what());
  }
  return int(ExitCode::failure);
}
