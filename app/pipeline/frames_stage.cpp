// The stage from a settled pile to recorded frames.
#include <cstdio>
#include <filesystem>
#include <memory>

#include "app/pipeline/build_scene.h"
#include "app/pipeline/frame_watch.h"
#include "app/pipeline/live.h"
#include "app/pipeline/recorders.h"
#include "app/pipeline/run.h"
#include "app/planning/camera_inside.h"
#include "app/planning/flight.h"
#include "app/provenance/frame_journal.h"
#include "app/support/stop.h"
#include "io/base/atomic_file.h"
#include "io/recording/recording_queue.h"
#include "kernel/base/disk_cache.h"
#include "kernel/base/hash.h"
#include "kernel/base/text.h"
#include "render/gl/gl_context.h"
#include "render/renderer.h"
#include "render/sensors/camera.h"
#include "scripting/sandbox/script_file.h"
#include "scripting/trajectory/imu.h"
#include "scripting/trajectory/trajectory.h"

namespace rubble {
namespace {

// labels.csv: what the numbers of the label channel mean.
void write_legend(const Run& run, RunFolder& folder) {
  if (!run.scenario.camera.channel_set().label) return;
  std::string text = "label,name\n";
  const std::vector<std::string> names = label_names(run.assets);
  for (std::size_t i = 0; i < names.size(); ++i) text += std::to_string(i) + "," + names[i] + "\n";
  write_text_file(folder.file("labels.csv"), text);
  folder.add("labels.csv");
}

// What the contact sheet says at its top.
std::string title(const Run& run) {
  return std::filesystem::path(run.recipe.script.path).stem().string() + "   seed " +
         std::to_string(run.scenario.seed) + "   " + std::to_string(run.pile.pieces.size()) +
         " pieces   state " + hex64(run.pile.state_hash());
}

void note_environment(Run& run, const GlInfo& info) {
  run.environment = {{"gl_renderer", info.renderer},
                     {"gl_version", info.version},
                     {"egl_device", info.egl_device},
                     {"threads", std::to_string(run.threads())}};
}

Renderer prepare_renderer(Run& run, GlContext& context) {
  RenderOptions options;
  options.threads = run.threads();
  options.cache_folder = DiskCache::usual_folder();
  return Renderer(context, build_scene(run.scenario, run.assets, run.pile), options,
                  [&](double fraction) { run.progress.update(fraction, "light"); });
}

double seconds_since(const Scenario& scenario, std::int64_t stamp_ns) {
  return double(stamp_ns - scenario.start_ns) * 1e-9;
}

// Takes every frame in order, notes its hashes, and hands it to the recorders.
void take_frames(Camera& camera, RecordingQueue& queue, Run& run, const RunFolder& folder) {
  FrameJournal journal(folder.frames_file());
  const CameraPath path(run.scenario.trajectory);
  Imu imu(path, run.scenario.imu.model, run.scenario.settle.gravity, run.scenario.seed,
          run.scenario.start_ns);
  DepthMetrics depth;
  FrameWatch watch;
  for (int i = 0; i < camera.frames(); ++i) {
    throw_if_stopped(folder.path());
    Frame frame = camera.take(i);
    frame.linear_velocity = path.motion_at(seconds_since(run.scenario, frame.stamp_ns)).velocity;
    if (run.scenario.imu.on) frame.imu = imu.take_until(frame.stamp_ns);
    run.frames.add(frame);
    journal.note(std::size_t(i), run.frames.frames.back());
    depth.add(frame);
    if (watch.notice(frame)) run.warnings.push_back(watch.warning());
    queue.push(std::move(frame));
    run.progress.update(double(i + 1) / camera.frames(),
                        "frame " + std::to_string(i + 1) + " of " +
                            std::to_string(camera.frames()));
  }
  depth.add_to(run.metrics);
}

// What the trajectory depends on besides the script becomes known: places in voids, ways around the
// pile. From here on the scenario's path is what is flown; flight.json holds it.
void resolve_path(Run& run, RunFolder& folder) {
  const bool quick = !run.scenario.trajectory.needs_pile();
  if (!quick) run.progress.start("flight");
  FlightPlan plan;
  try {
    plan = resolve_flight(run.scenario, run.assets, run.pile, run.threads(),
                          [&](double done, const std::string& what) {
                            throw_if_stopped(folder.path());
                            run.progress.update(done, what);
                          });
  } catch (const InputError& error) {
    std::vector<Diagnostic> mistakes = error.diagnostics();
    locate(mistakes, run.recipe.script.path, SourceMap(run.recipe.script.text, "mission"));
    throw InputError(std::move(mistakes));
  }
  if (!quick) run.progress.finish(plan.summary.empty() ? "planned" : plan.summary);
  if (!plan.json.empty()) {
    write_text_file(folder.file("flight.json"), plan.json);
    folder.add("flight.json");
  }
  run.scenario.trajectory = plan.trajectory;
  std::vector<Vec3> positions;
  for (const CameraPose& pose : plan.poses) positions.push_back(pose.world_from_camera.translation);
  if (const auto warning = find_camera_inside(run.assets, run.pile, positions))
    run.warnings.push_back(*warning);
}

}  // namespace

void render_frames(Run& run, RunFolder& folder) {
  resolve_path(run, folder);
  run.progress.start("scene");
  GlContext context({run.options.gl_device, run.threads()});
  note_environment(run, context.info());
  Renderer renderer = prepare_renderer(run, context);
  Camera camera(renderer, build_camera(run.scenario, run.threads()), build_flight(run.scenario),
                Medium(run.scenario.air, run.scenario.seed));
  run.progress.finish("ready on " + context.info().renderer);

  run.progress.start("render");
  const Recording recording = describe_recording(run.scenario, run.assets, run.pile);
  RecorderSet set =
      make_recorders(run.scenario, recording, camera.frames(), title(run), folder.path());
  folder.expect(set.names);
  add_live_recorders(set, run.options, ros_options(run.scenario.outputs, recording));
  RecordingQueue queue(std::move(set.recorders));
  take_frames(camera, queue, run, folder);
  run.progress.finish(std::to_string(camera.frames()) + " frames");
  for (const std::string& warning : run.warnings)
    std::fprintf(stderr, "rubble: warning: %s\n", printable(warning).c_str());

  run.progress.start("record");
  queue.finish();
  for (const std::string& name : set.names) folder.add(name);
  write_legend(run, folder);
  folder.hash_files(run.threads());
  run.progress.finish(std::to_string(set.names.size()) + " files");
}

}  // namespace rubble
