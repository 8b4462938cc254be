// The command lines of `rubble eval`.
#include <memory>

#include "app/commands/arguments.h"

namespace rubble {
namespace {

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

void add_score_options(CLI::App& command, ScoreOutput& output) {
  command.add_flag("--json", output.json, "The result as JSON");
  add_list(command, "--out", output.files, "Write the table: .csv, .json or .tex (LaTeX)", "FILE");
}

Action add_eval_trajectory(CLI::App& command) {
  const auto request = std::make_shared<TrajectoryRequest>();
  add_trajectory_options(command, *request);
  return [request] { return eval_trajectory(*request); };
}

Action add_eval_sfm(CLI::App& command) {
  const auto request = std::make_shared<SfmRequest>();
  command.add_option("datasets", request->datasets, "Output folders of runs with outputs.colmap")
      ->required();
  command
      .add_option("--model", request->model,
                  "In each dataset, COLMAP's model or the folder of its numbered models "
                  "(default: sfm/sparse)")
      ->type_name("DIR");
  command
      .add_option("--bound", request->bound,
                  "A frame is on track when it is no farther from the truth (default: 0.1)")
      ->type_name("METRES")
      ->check(CLI::PositiveNumber);
  command
      .add_option(
          "--details", request->details,
          "Write there, for each dataset, the points in its world (PLY) and the track (CSV)")
      ->type_name("DIR");
  add_list(command, "--assets", request->asset_packs, "A folder where packs may be now", "DIR");
  add_score_options(command, request->output);
  return [request] { return eval_sfm(*request); };
}

Action add_eval_surface(CLI::App& command) {
  const auto request = std::make_shared<SurfaceRequest>();
  command.add_option("dataset", request->dataset, "Output folder of a run with outputs.colmap")
      ->required();
  command.add_option("mesh", request->mesh, "A mesh or point cloud, PLY")->required();
  command
      .add_option(
          "--align", request->align,
          "The COLMAP model whose frame it has (default: it is in the world of the dataset)")
      ->type_name("DIR");
  add_list(command, "--assets", request->asset_packs, "A folder where packs may be now", "DIR");
  add_score_options(command, request->output);
  return [request] { return eval_surface(*request); };
}

Action add_eval_map(CLI::App& command) {
  const auto request = std::make_shared<MapRequest>();
  command.add_option("map", request->map, "The map: a mesh or point cloud, PLY")->required();
  command.add_option("dataset", request->dataset, "Output folder of the run it was made from")
      ->required();
  command
      .add_option("--align", request->align,
                  "The COLMAP model whose frame the map has, brought to the world by a similarity "
                  "(default: the map is in the world of the dataset)")
      ->type_name("DIR");
  command
      .add_option("--range", request->range,
                  "Farther than this no frame sees (default: the depth sensor's range, or 10)")
      ->type_name("METRES")
      ->check(CLI::Range(0.01, 1000.0));
  add_space_options(command, *request, "0.05");
  command
      .add_option("--details", request->details,
                  "Write there the map by its errors and the seen surface by what the map has of it "
                  "(PLY), and the entrances (CSV)")
      ->type_name("DIR");
  add_list(command, "--assets", request->asset_packs, "A folder where packs may be now", "DIR");
  add_score_options(command, request->output);
  add_threads_option(command, request->options.threads,
                     "Threads to use; 0: all processors. Results do not depend on it");
  command.add_flag("--quiet", request->options.quiet, "No progress, only errors");
  return [request] { return eval_map(*request); };
}

}  // namespace

Action add_eval(CLI::App& command) {
  command.require_subcommand(1);
  CLI::App* const trajectory = command.add_subcommand(
      "trajectory", "Absolute and relative errors of a trajectory, as evo's");
  CLI::App* const sfm = command.add_subcommand(
      "sfm", "What COLMAP made of datasets: track, points, distance to the true surface");
  CLI::App* const surface =
      command.add_subcommand("surface", "Distance of a mesh or cloud from the true surface");
  CLI::App* const map = command.add_subcommand(
      "map", "A map against the surface that its run saw, and the voids it found");
  const Action on_trajectory = add_eval_trajectory(*trajectory), on_sfm = add_eval_sfm(*sfm),
               on_surface = add_eval_surface(*surface), on_map = add_eval_map(*map);
  return [=] {
    return *sfm ? on_sfm() : *surface ? on_surface() : *map ? on_map() : on_trajectory();
  };
}

}  // namespace rubble
