// The run, top to bottom: script -> scenario -> assets -> pile -> scene -> frames -> files.
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <thread>

#include "app/asset_library.h"
#include "app/build_scene.h"
#include "app/commands.h"
#include "app/manifest.h"
#include "app/output_folder.h"
#include "app/progress.h"
#include "io/atomic_file.h"
#include "io/contact_sheet.h"
#include "io/mesh_file.h"
#include "io/pile_state_file.h"
#include "io/rawlog_recorder.h"
#include "io/recording_queue.h"
#include "io/rosbag_recorder.h"
#include "io/tum_recorder.h"
#include "kernel/base/hash.h"
#include "kernel/settle.h"
#include "render/gl_context.h"
#include "render/renderer.h"
#include "scripting/mission.h"
#include "scripting/trajectory.h"

namespace rubble {
namespace {

volatile std::sig_atomic_t stop_requested = 0;

// Ctrl-C and a polite kill end the run between two steps, so that no file is left half-written.
void stop_on_signals() {
  for (const int signal : {SIGINT, SIGTERM})
    std::signal(signal, [](int) { stop_requested = 1; });
}

void throw_if_stopped() {
  if (stop_requested) throw RunError("stopped by a signal; unfinished files were removed");
}

int count_threads(int asked) {
  if (asked > 0) return asked;
  return std::max(1, int(std::thread::hardware_concurrency()));
}

std::string choose_output(const RunRequest& request) {
  if (!request.out.empty()) return request.out;
  return "out/" + std::filesystem::path(request.mission).stem().string();
}

MissionOptions mission_options(const RunRequest& request) {
  MissionOptions options;
  options.seed = request.seed;
  options.overrides = request.overrides;
  return options;
}

// One run's state, filled from the top down.
struct Run {
  explicit Run(const RunRequest& r)
      : request(r),
        progress(choose_progress_style(r.quiet)),
        mission(load_mission(r.mission, mission_options(r))) {}

  const RunRequest& request;
  Progress progress;
  Mission mission;
  AssetLibrary assets;
  PileState pile;
  std::map<std::string, std::string> environment;
};

void load(Run& run) {
  run.progress.start("assets");
  for (const std::string& line : run.mission.printed) std::fprintf(stderr, "%s\n", line.c_str());
  run.assets = load_assets(run.mission, run.request.asset_packs);
  for (const std::string& warning : run.assets.warnings)
    std::fprintf(stderr, "warning: %s\n", warning.c_str());
  run.progress.finish(std::to_string(run.assets.types.size()) + " loaded, seed " +
                      std::to_string(run.mission.scenario.seed));
}

void settle(Run& run) {
  const Scenario& scenario = run.mission.scenario;
  run.progress.start("settle");
  const Pile pile = generate_pile(build_pile_spec(scenario, run.assets));
  SettleOptions options = scenario.settle;
  options.threads = count_threads(run.request.threads);
  run.pile = settle_pile(pile, options, [&](const SettleProgress& p) {
    const double limit = p.layer < p.layers ? options.layer_time_limit : options.final_time_limit;
    const double layer = std::min(1.0, p.layer_time / limit);
    run.progress.update((std::max(0, p.layer - 1) + layer) / std::max(1, p.layers),
                        "layer " + std::to_string(p.layer) + " of " + std::to_string(p.layers) +
                            ", " + std::to_string(p.awake) + " of " + std::to_string(p.pieces) +
                            " pieces moving");
    return !stop_requested;
  });
  throw_if_stopped();
  char text[160];
  std::snprintf(text, sizeof text, "%zu pieces %s after %.1f simulated s, %d lost",
                run.pile.pieces.size(), run.pile.settled ? "at rest" : "did not settle",
                run.pile.simulated, run.pile.lost);
  run.progress.finish(text);
}

void write_pile(Run& run, OutputFolder& folder) {
  save_pile_state(run.pile, folder.file("pile.bin"));
  folder.add("pile.bin");
  if (!run.mission.scenario.outputs.stl) return;
  write_stl(folder.file("pile.stl"), build_mesh_instances(run.assets, run.pile));
  folder.add("pile.stl");
}

// labels.csv: what the numbers of the label channel mean.
void write_legend(const Run& run, OutputFolder& folder) {
  if (!run.mission.scenario.camera.channel_set().label) return;
  std::string text = "label,name\n";
  const std::vector<std::string> names = label_names(run.assets);
  for (std::size_t i = 0; i < names.size(); ++i)
    text += std::to_string(i) + "," + names[i] + "\n";
  write_text_file(folder.file("labels.csv"), text);
  folder.add("labels.csv");
}

// What the contact sheet says at its top.
std::string title(const Run& run) {
  return std::filesystem::path(run.request.mission).stem().string() + "   seed " +
         std::to_string(run.mission.scenario.seed) + "   " +
         std::to_string(run.pile.pieces.size()) + " pieces   state " +
         hex64(run.pile.state_hash());
}

// The recorders that the scenario asks for, and the names of their files.
std::vector<std::unique_ptr<Recorder>> make_recorders(const OutputScenario& outputs, int frames,
                                                      const std::string& title,
                                                      const OutputFolder& folder,
                                                      std::vector<std::string>& names) {
  std::vector<std::unique_ptr<Recorder>> recorders;
  const auto add = [&](bool wanted, const char* name, const auto& make) {
    if (!wanted) return;
    names.push_back(name);
    recorders.push_back(make(folder.file(name)));
  };
  const RosbagOptions bag{outputs.depth == DepthEncoding::metres ? BagDepth::metres
                                                                 : BagDepth::millimetres,
                          true};
  add(outputs.rawlog, "mission.rawlog", [](const std::string& p) { return make_rawlog_recorder(p); });
  add(outputs.bag, "mission.bag",
      [&](const std::string& p) { return make_rosbag_recorder(p, bag); });
  add(outputs.groundtruth, "groundtruth.txt",
      [](const std::string& p) { return make_tum_trajectory_recorder(p); });
  ContactSheetOptions sheet;
  sheet.total_frames = frames;
  sheet.title = title;
  add(outputs.preview, "preview.png",
      [&](const std::string& p) { return make_contact_sheet_recorder(p, sheet); });
  return recorders;
}

int render_and_record(Run& run, OutputFolder& folder) {
  const Scenario& scenario = run.mission.scenario;
  const std::vector<CameraPose> poses = sample_trajectory(scenario.trajectory, scenario.start_ns);
  const int threads = count_threads(run.request.threads);

  run.progress.start("scene");
  GlContext context({-1, threads});
  run.environment = {{"gl_renderer", context.info().renderer},
                     {"gl_version", context.info().version},
                     {"egl_device", context.info().egl_device},
                     {"threads", std::to_string(threads)}};
  RenderOptions options;
  options.threads = threads;
  Renderer renderer(context, build_scene(scenario, run.assets, run.pile), options,
                    [&](double fraction) { run.progress.update(fraction, "light"); });
  run.progress.finish("ready on " + context.info().renderer);

  run.progress.start("render");
  std::vector<std::string> names;
  RecordingQueue queue(make_recorders(scenario.outputs, int(poses.size()), title(run), folder, names));
  for (std::size_t i = 0; i < poses.size(); ++i) {
    throw_if_stopped();
    Frame frame = renderer.render(poses[i].world_from_camera, scenario.camera.intrinsics(), int(i),
                                  poses[i].stamp_ns);
    const Pose* next = i + 1 < poses.size() ? &poses[i + 1].world_from_camera : nullptr;
    renderer.add_channels(scenario.camera.channel_set(), next, frame);
    queue.push(std::move(frame));
    run.progress.update(double(i + 1) / double(poses.size()),
                        "frame " + std::to_string(i + 1) + " of " + std::to_string(poses.size()));
  }
  run.progress.finish(std::to_string(poses.size()) + " frames");

  run.progress.start("record");
  queue.finish();
  for (const std::string& name : names) folder.add(name);
  write_legend(run, folder);
  run.progress.finish(std::to_string(names.size()) + " files");
  return int(poses.size());
}

void write_manifest(const Run& run, const OutputFolder& folder, int frames) {
  ManifestContents contents;
  contents.mission = &run.mission;
  contents.assets = &run.assets;
  contents.pile = &run.pile;
  contents.frames = frames;
  contents.outputs = folder.hashes();
  contents.wall_seconds = run.progress.wall_seconds();
  contents.environment = run.environment;
  write_text_file(folder.file("manifest.json"), make_manifest(contents));
}

ExitCode report(const Run& run, const OutputFolder& folder) {
  std::printf("%s\n", folder.path().c_str());
  if (run.pile.settled) return ExitCode::done;
  int moving = 0;
  for (const PieceState& piece : run.pile.pieces) moving += piece.status == PieceStatus::moving;
  std::fprintf(stderr,
               "the pile did not settle: %d of %zu pieces still moved when the time limit came "
               "(settle.final_time_limit = %g s)\n",
               moving, run.pile.pieces.size(), run.mission.scenario.settle.final_time_limit);
  return ExitCode::did_not_settle;
}

// Up to the files of the pile: what `run` and `settle` share.
OutputFolder settle_to_files(Run& run) {
  stop_on_signals();
  load(run);
  OutputFolder folder(choose_output(run.request), run.request.force);
  settle(run);
  write_pile(run, folder);
  return folder;
}

}  // namespace

ExitCode run_mission(const RunRequest& request) {
  Run run(request);
  OutputFolder folder = settle_to_files(run);
  const int frames = render_and_record(run, folder);
  write_manifest(run, folder, frames);
  return report(run, folder);
}

ExitCode settle_mission(const RunRequest& request) {
  Run run(request);
  const OutputFolder folder = settle_to_files(run);
  write_manifest(run, folder, 0);
  return report(run, folder);
}

}  // namespace rubble
