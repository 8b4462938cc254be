// `rubble eval sfm`: reconstructions against the true cameras and surface.
#include <filesystem>
#include <memory>
#include <set>

#include "app/command_line/command.h"
#include "app/commands/eval/score_output.h"
#include "app/eval/scores/saved_surface.h"
#include "app/eval/sfm/sfm_details.h"
#include "app/eval/sfm/sfm_score.h"
#include "kernel/base/system/output_files.h"

namespace rubble {
namespace {

struct SfmRequest {
  std::vector<std::string> datasets;     // folders of runs
  std::string model = "sfm/sparse";      // --model: inside each, or absolute
  double bound = 0.1;                    // --bound: on track are frames nearer than this; unit: m
  std::string details;                   // --details: folder for aligned points and tracks
  std::vector<std::string> asset_packs;  // --assets DIR: where its packs may be now
  ScoreOutput output;
};

std::vector<ScoreCell> make_cells(const SfmScore& s) {
  return {{"frames", "sequence length", s.frames, 0},
          {"segments", "track segments", s.segments, 0},
          {"registered", "frames registered", s.registered, 0},
          {"on_track", "frames on track", s.on_track, 0},
          {"on_track_percent", "on track, %", s.on_track_percent(), 1},
          {"points", "points", double(s.points), 0},
          {"ate_rmse_m", "ATE (Sim3), m", s.ate_rmse, 4},
          {"rpe_trans_rmse_m", "RPE, m", s.rpe_trans_rmse, 4},
          {"rpe_rot_rmse_deg", "RPE, degrees", s.rpe_rot_rmse_deg, 3},
          {"reprojection_px", "reprojection error, px",
           s.points > 0 ? std::optional<double>(s.reprojection) : std::nullopt, 3}};
}

ScoreRow score_dataset(const std::string& dataset, const SfmRequest& request) {
  const SfmGroundTruth truth = load_sfm_ground_truth(dataset);
  // An absolute path stays as it is: std::filesystem's operator /
  const std::string models = (std::filesystem::path(dataset) / request.model).string();
  const std::vector<SfmSegment> segments = load_segments(models, truth);
  ScoreRow row{name_of(dataset), make_cells(calc_sfm_score(segments, truth, request.bound))};
  if (!request.details.empty()) write_sfm_details(request.details, row.name, segments, truth);
  const SavedSurface surface(dataset, request.asset_packs);
  const PileQueries& queries = surface.geometry.queries;
  add_surface_cells(calc_surface_score(align_points_of(segments), queries,
                                       find_visible_surface(queries, truth.model)),
                    row.cells);
  return row;
}

ExitCode eval_sfm(const SfmRequest& request) {
  check_score_files(request.output);
  if (request.datasets.size() > 1 && std::filesystem::path(request.model).is_absolute())
    throw InputError({"", 0, "--model", "is one folder for several datasets",
                      "a path inside each dataset", request.model, ""});
  if (!request.details.empty()) {
    std::set<std::string> names;
    for (const std::string& dataset : request.datasets)
      if (!names.insert(name_of(dataset)).second)
        throw InputError({"", 0, "--details", "two datasets have one name, which names their files there", "folders of different names",
                          name_of(dataset), "score them one after the other, with a folder for each"});
    make_output_folder(request.details);
  }
  std::vector<ScoreRow> rows;
  for (const std::string& dataset : request.datasets)
    rows.push_back(score_dataset(dataset, request));
  print_score(rows, request.output);
  return ExitCode::done;
}

Action declare_eval_sfm(CommandLine& line) {
  const auto request = std::make_shared<SfmRequest>();
  line.add("datasets", request->datasets, "Output folders of runs with outputs.colmap").required().metavar("DIR");
  line.add("--model", request->model,
           "The COLMAP model in each dataset, or the folder of its numbered models")
      .shows_default()
      .metavar("DIR");
  line.add("--bound", request->bound, "Largest position error of a frame on track")
      .shows_default()
      .metavar("METRES")
      .positive();
  line.add("--details", request->details,
           "Folder for the points in the world frame (PLY) and the track (CSV) of each dataset")
      .metavar("DIR");
  add_packs_option(line, request->asset_packs, "Folder of an asset pack of the run, if it was moved");
  add_score_options(line, request->output);
  return [request] { return eval_sfm(*request); };
}

}  // namespace

Command eval_sfm_command() {
  return {"eval", "sfm",
          "Score COLMAP reconstructions: track, points, distance to the true surface",
          declare_eval_sfm};
}

}  // namespace rubble
