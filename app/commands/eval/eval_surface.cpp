// `rubble eval surface`: a mesh or point cloud against the true surface.
#include <memory>

#include "app/command_line/command.h"
#include "app/commands/eval/score_output.h"
#include "app/eval/scores/saved_surface.h"
#include "app/eval/sfm/sfm_score.h"

namespace rubble {
namespace {

struct SurfaceRequest {
  std::string dataset, mesh;             // the folder of a run; a PLY file
  std::string align;                     // --align: COLMAP model whose frame the mesh has
  std::vector<std::string> asset_packs;  // --assets
  ScoreOutput output;
};

ExitCode eval_surface(const SurfaceRequest& request) {
  constexpr double kSpacing = 0.02;  // unit: m
  check_score_files(request.output);
  const SfmGroundTruth truth = load_sfm_ground_truth(request.dataset);
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

Action declare_eval_surface(CommandLine& line) {
  const auto request = std::make_shared<SurfaceRequest>();
  line.add("dataset", request->dataset, "Output folder of a run with outputs.colmap").required().metavar("DIR");
  line.add("mesh", request->mesh, "The mesh or point cloud, PLY").required().metavar("FILE");
  line.add("--align", request->align, "The COLMAP model in whose frame the mesh is")
      .shows_default_text("the mesh is in the world of the dataset")
      .metavar("DIR");
  add_packs_option(line, request->asset_packs, "Folder of an asset pack of the run, if it was moved");
  add_score_options(line, request->output);
  return [request] { return eval_surface(*request); };
}

}  // namespace

Command eval_surface_command() {
  return {"eval", "surface", "Score a mesh or point cloud: distances from the true surface",
          declare_eval_surface};
}

}  // namespace rubble
