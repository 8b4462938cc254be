// `rubble eval sfm` and `rubble eval surface`: reconstructions against the true cameras and
// surface.
#include <cstdio>
#include <filesystem>

#include "app/commands/commands.h"
#include "app/eval/scores/saved_surface.h"
#include "app/eval/scores/score_table.h"
#include "app/eval/scores/surface_score.h"
#include "app/eval/sfm/sfm_details.h"
#include "app/eval/sfm/sfm_score.h"

namespace rubble {
namespace {

std::string name_of(const std::string& folder) {
  const auto path = std::filesystem::path(folder).lexically_normal();
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

void add_surface_cells(const std::optional<SurfaceScore>& s, std::vector<ScoreCell>& cells) {
  const auto percent = [&](double SurfaceScore::*share) {
    return s ? std::optional<double>(100 * (*s).*share) : std::nullopt;
  };
  cells.push_back({"within_1cm_percent", "within 1 cm of the surface, %",
                   percent(&SurfaceScore::within_1cm), 1});
  cells.push_back({"within_2cm_percent", "within 2 cm, %", percent(&SurfaceScore::within_2cm), 1});
  cells.push_back({"within_5cm_percent", "within 5 cm, %", percent(&SurfaceScore::within_5cm), 1});
  cells.push_back({"median_distance_m", "median distance, m",
                   s ? std::optional<double>(s->median) : std::nullopt, 4});
  cells.push_back({"completeness_5cm_percent", "visible surface covered within 5 cm, %",
                   percent(&SurfaceScore::completeness_5cm), 1});
}

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
  const SfmTruth truth = load_sfm_truth(dataset);
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

void print_score(const std::vector<ScoreRow>& rows, const ScoreOutput& output) {
  for (const std::string& path : output.files) write_score_file(path, rows);
  std::fputs((output.json ? score_json(rows) : score_text(rows)).c_str(), stdout);
}

}  // namespace

ExitCode eval_sfm(const SfmRequest& request) {
  for (const std::string& path : request.output.files) check_score_file(path);
  if (request.datasets.size() > 1 && std::filesystem::path(request.model).is_absolute())
    throw InputError({"", 0, "--model", "is one folder for several datasets",
                      "a path inside each dataset", request.model, ""});
  if (!request.details.empty()) std::filesystem::create_directories(request.details);
  std::vector<ScoreRow> rows;
  for (const std::string& dataset : request.datasets)
    rows.push_back(score_dataset(dataset, request));
  print_score(rows, request.output);
  return ExitCode::done;
}

ExitCode eval_surface(const SurfaceRequest& request) {
  constexpr double kSpacing = 0.02;  // unit: m
  for (const std::string& path : request.output.files) check_score_file(path);
  const SfmTruth truth = load_sfm_truth(request.dataset);
  PlyMesh mesh = load_ply(request.mesh);
  if (!request.align.empty()) align_to_world(request.align, truth, mesh.positions);
  check_area(mesh, kSpacing, request.mesh);
  const SavedSurface surface(request.dataset, request.asset_packs);
  const PileQueries& queries = surface.geometry.queries;
  const auto score = calc_surface_score(sample_surface(mesh, kSpacing), queries,
                                        find_visible_surface(queries, truth.model));
  ScoreRow row{name_of(request.mesh), {}};
  row.cells.push_back({"triangles", "triangles", double(mesh.triangles.size()), 0});
  row.cells.push_back({"samples", "samples", score ? double(score->samples) : 0, 0});
  add_surface_cells(score, row.cells);
  print_score({row}, request.output);
  return ExitCode::done;
}

}  // namespace rubble
