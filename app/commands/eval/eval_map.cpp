// `rubble eval map`: a reconstructed map against the surface and the voids that its run saw.
#include <algorithm>
#include <filesystem>
#include <memory>

#include "app/command_line/command.h"
#include "app/command_line/common_options.h"
#include "app/commands/eval/score_output.h"
#include "app/eval/map/map_report.h"
#include "app/eval/scores/saved_surface.h"
#include "app/eval/scores/surface_score.h"
#include "app/eval/sfm/sfm_score.h"
#include "app/provenance/provenance.h"
#include "app/support/print.h"
#include "app/support/progress.h"
#include "app/support/stop.h"
#include "kernel/base/system/output_files.h"

namespace rubble {
namespace {

struct MapRequest {
  std::string map, dataset;              // a PLY file; the folder of a run
  std::string align;                     // --align: COLMAP model whose frame the map has
  SpaceRequest space;                    // voxel: of the map's free space
  std::optional<double> range;           // --range: of the camera's depth; unit: m
  std::string details;                   // --details: folder for clouds and the entrances
  std::vector<std::string> asset_packs;  // --assets
  ScoreOutput output;
  RunOptions options;
};

constexpr double kMapSpacing = 0.02;  // of samples of a mesh; unit: m

double sample_spacing(const MapRequest& request) {
  return std::min(kMapSpacing, request.space.voxel / 2);
}

RecordedViews load_views(const FinishedRun& saved, const MapRequest& request) {
  const Scenario scenario = stated_scenario(saved.manifest.provenance);
  RecordedViews views;
  for (const MountedCamera& camera : scenario.cameras) {
    const DepthSensorSpec& sensor = camera.depth_sensor;
    ViewRange range;
    if (sensor.type != DepthSensorType::none && sensor.type != DepthSensorType::ideal)
      range = {sensor.min_range, sensor.max_range};
    if (request.range) range.farthest = *request.range;
    const Intrinsics intrinsics = camera.camera.intrinsics();
    views.add({intrinsics, Lens(intrinsics), range}, load_true_poses(camera.folder_in(saved.folder)));
  }
  return views;
}

VoidMap make_void_map(const SavedSurface& surface, const MapRequest& request, Progress& progress) {
  VoidSpaceOptions options;
  options.voxel = request.space.voxel;
  const double largest = *std::max_element(request.space.radii.begin(), request.space.radii.end());
  options.rolling_radius = outside_radius_for(request.space.outside_radius, largest);
  options.memory_limit = request.space.memory_gib * (1 << 30);
  options.threads = request.options.threads;
  options.scenery = surface.geometry.terrain;
  const auto report = [&](double from, double share) {
    return [&progress, from, share](double done) {
      throw_if_stopped("");
      progress.update(from + share * done, "voids");
      return true;
    };
  };
  VoidSpace space = calc_void_space(surface.pile, surface.geometry.meshes, options, report(0, 0.6));
  return find_voids(std::move(space), request.space.radii, report(0.6, 0.4));
}

MapFindings::Voids find_by(const std::vector<Vec3>& map, const VoidMap& voids,
                           const SavedSurface& surface, const RecordedViews& views,
                           ThreadPool& pool) {
  const CarvedSpace carved(voids.space.grid, map, surface.geometry.queries, views, pool);
  MapFindings::Voids result;
  result.volume = calc_known_volume(voids.space, carved);
  for (const RobotVoids& robot : voids.robots)
    result.robots.push_back(find_known_voids(voids.space, robot, carved));
  return result;
}

// Without its extension, so that it can begin the names of files.
std::string name_of_map(const std::string& path) {
  return std::filesystem::path(path).stem().string();
}

MapFindings score_map(const MapRequest& request, const SavedSurface& surface, PlyMesh map,
                      const VoidMap& voids, Progress& progress) {
  ThreadPool pool(request.options.threads);
  const RecordedViews views = load_views(surface.saved, request);
  const PileQueries& queries = surface.geometry.queries;
  const auto step = [&](double done, const char* what) {
    throw_if_stopped("");
    progress.update(done, what);
  };
  MapFindings findings;
  findings.map = std::move(map);
  findings.samples = sample_surface(findings.map, sample_spacing(request));
  step(0, "visible surface");
  findings.seen = find_seen_surface(surface.pile, surface.geometry.meshes, queries, views,
                                    std::min(SeenPoints().spacing, request.space.voxel / 2), pool);
  step(0.4, "accuracy");
  findings.accuracy = calc_map_accuracy(findings.samples, queries, findings.seen, pool);
  step(0.5, "completeness");
  findings.completeness = calc_map_completeness(findings.map, findings.seen, pool);
  step(0.6, "free space of the map");
  findings.found = find_by(findings.samples, voids, surface, views, pool);
  step(0.8, "free space that could be seen");
  findings.best = find_by(findings.seen.points, voids, surface, views, pool);
  return findings;
}

void print_map(const MapRequest& request, const MapFindings& findings, const VoidMap& voids) {
  const std::string name = name_of_map(request.map);
  const std::vector<ScoreRow> rows{make_map_row(name, findings, voids)};
  for (const std::string& path : request.output.files) write_score_file(path, rows);
  if (!request.details.empty()) {
    make_output_folder(request.details);
    write_map_details(request.details, name, findings, voids);
  }
  print_result(request.output.json ? score_json(rows) : score_text(rows), request.output.json);
  if (!request.output.json) print_out("%s", entrance_text(findings, voids).c_str());
}

ExitCode eval_map(const MapRequest& request) {
  stop_on_signals();
  check_score_files(request.output);
  PlyMesh map = load_ply(request.map);
  const SavedSurface surface(request.dataset, request.asset_packs);
  load_views(surface.saved, request);  // complains before anything takes long
  if (!request.align.empty())
    align_to_world(request.align, load_sfm_ground_truth(request.dataset), map.positions);
  check_area(map, sample_spacing(request), request.map);
  Progress progress(choose_progress_style(request.options.quiet));
  progress.start("voids");
  const VoidMap voids = make_void_map(surface, request, progress);
  progress.finish("");
  progress.start("map");
  const MapFindings findings = score_map(request, surface, std::move(map), voids, progress);
  progress.finish("");
  print_map(request, findings, voids);
  return ExitCode::done;
}

Action declare_eval_map(CommandLine& line) {
  const auto request = std::make_shared<MapRequest>();
  request->space.voxel = 0.05;
  line.add("map", request->map, "The map: a mesh or point cloud, PLY").required().metavar("FILE");
  line.add("dataset", request->dataset, "Output folder of the run from which the map was made").required().metavar("DIR");
  line.add("--align", request->align,
           "The COLMAP model in whose frame the map is; the map is aligned by a similarity transform")
      .shows_default_text("the map is in the world of the dataset")
      .metavar("DIR");
  line.add("--range", request->range, "Largest distance of a visible surface from a frame")
      .shows_default_text("the depth sensor's range, or 10")
      .metavar("METRES")
      .within(0.01, 1000.0);
  add_space_options(line, request->space);
  line.add("--details", request->details,
           "Folder for the map coloured by error and the visible surface coloured by coverage (PLY), and for the "
           "entrances (CSV)")
      .metavar("DIR");
  add_packs_option(line, request->asset_packs, "Folder of an asset pack of the run, if it was moved");
  add_score_options(line, request->output);
  add_threads_option(line, request->options.threads);
  add_quiet_option(line, request->options.quiet);
  return [request] { return eval_map(*request); };
}

}  // namespace

Command eval_map_command() {
  return {"eval", "map", "Score a map: visible surface, voids, entrances", declare_eval_map};
}

}  // namespace rubble
