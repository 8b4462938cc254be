// The stage from a settled pile to recorded frames.
#include <cstdio>
#include <filesystem>
#include <memory>

#include "app/pipeline/build_scene.h"
#include "app/pipeline/frame_watch.h"
#include "app/pipeline/live.h"
#include "app/pipeline/recorders.h"
#include "app/pipeline/sensors.h"
#include "app/pipeline/stages.h"
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
#include "scripting/sandbox/script_file.h"
#include "scripting/trajectory/trajectory.h"

namespace rubble {
namespace {

// labels.csv: what the numbers of the label channel mean.
void write_legend(const ResolvedMission& mission, RunFolder& folder) {
  if (!has_channel(mission.scenario, "label")) return;
  std::string text = "label,name\n";
  const std::vector<std::string> names = label_names(mission.assets);
  for (std::size_t i = 0; i < names.size(); ++i) text += std::to_string(i) + "," + names[i] + "\n";
  write_text_file(folder.file("labels.csv"), text);
  folder.add("labels.csv");
}

// What the contact sheet says at its top.
std::string title_of(const ResolvedMission& mission, const PileState& pile) {
  return std::filesystem::path(mission.provenance.script.path).stem().string() + "   seed " +
         std::to_string(mission.scenario.seed) + "   " + std::to_string(pile.pieces.size()) +
         " pieces   state " + hex64(pile.state_hash());
}

std::map<std::string, std::string> describe_environment(const GlInfo& info, int threads) {
  return {{"gl_renderer", info.renderer},
          {"gl_version", info.version},
          {"egl_device", info.egl_device},
          {"threads", std::to_string(threads)}};
}

std::vector<std::string> names_of_cameras(const Scenario& scenario) {
  std::vector<std::string> names;
  for (const MountedCamera& camera : scenario.cameras) names.push_back(camera.name);
  return names;
}

// What is worked out from the frames while they pass.
struct FrameFigures {
  FrameJournal journal;
  DepthMetrics depth;
  FrameWatch watch;
};

void look_at_frame(const Frame& frame, FrameFigures& figures, RecordedFrames& recorded,
                   RunContext& context) {
  recorded.hashes.add(frame);
  figures.journal.note(recorded.hashes.frames.size() - 1, recorded.hashes.frames.back());
  figures.depth.add(frame);
  if (figures.watch.notice(frame)) context.warnings.push_back(figures.watch.warning());
}

// Takes every sample in order, notes the hashes of frames, and hands it to the recorders.
void take_samples(SensorSuite& sensors, RecordingQueue& queue, const RunFolder& folder,
                  RunContext& context, RecordedFrames& recorded) {
  FrameFigures figures{FrameJournal(folder.frames_file()), {}, {}};
  const int all = sensors.count_frames();
  throw_if_stopped(folder.path());
  while (std::optional<Sample> sample = sensors.take()) {
    if (const auto* reading = std::get_if<ImuSample>(&*sample)) {
      recorded.hashes.add_imu(*reading);
      queue.push(*std::move(sample));
      continue;
    }
    look_at_frame(std::get<Frame>(*sample), figures, recorded, context);
    queue.push(*std::move(sample));
    const auto done = recorded.hashes.frames.size();
    context.progress.update(double(done) / all, "frame " + std::to_string(done) + " of " +
                                                    std::to_string(all));
    throw_if_stopped(folder.path());
  }
  figures.depth.add_to(recorded.metrics);
}

FlightPlan plan_flight(const ResolvedMission& mission, const PileState& pile,
                       const RunFolder& folder, RunContext& context) {
  try {
    return resolve_flight(mission.scenario, mission.assets, pile, context.threads(),
                          [&](double done, const std::string& what) {
                            throw_if_stopped(folder.path());
                            context.progress.update(done, what);
                          });
  } catch (const InputError& error) {
    const SourceFile& script = mission.provenance.script;
    std::vector<Diagnostic> mistakes = error.diagnostics();
    locate(mistakes, script.path, SourceMap(script.text, "mission"));
    throw InputError(std::move(mistakes));
  }
}

void warn_of_cameras_inside(const ResolvedMission& mission, const Scenario& flown,
                            const PileState& pile, RunContext& context) {
  for (const MountedCamera& camera : all_cameras(flown)) {
    std::vector<Vec3> positions;
    for (const Pose& pose : build_flight(flown, camera).world_from_camera)
      positions.push_back(pose.translation);
    const auto warning = find_camera_inside(mission.assets, pile, positions);
    if (!warning) continue;
    const std::string who = flown.cameras.empty() ? "" : "camera `" + camera.name + "`: ";
    context.warnings.push_back(who + *warning);
  }
}

// The scenario with what its trajectory depends on besides the script: places in voids, ways around
// the pile. flight.json holds it.
Scenario resolve_path(const ResolvedMission& mission, const PileState& pile, RunFolder& folder,
                      RunContext& context) {
  const bool quick = !mission.scenario.trajectory.needs_pile();
  if (!quick) context.progress.start("flight");
  const FlightPlan plan = plan_flight(mission, pile, folder, context);
  if (!quick) context.progress.finish(plan.summary.empty() ? "planned" : plan.summary);
  if (!plan.json.empty()) {
    write_text_file(folder.file("flight.json"), plan.json);
    folder.add("flight.json");
  }
  Scenario flown = mission.scenario;
  flown.trajectory = plan.trajectory;
  warn_of_cameras_inside(mission, flown, pile, context);
  return flown;
}

// Frames into files, until the last file is complete.
void record(SensorSuite& sensors, const ResolvedMission& mission, const Scenario& flown,
            const PileState& pile, RunFolder& folder, RunContext& context,
            RecordedFrames& recorded) {
  context.progress.start("render");
  const Recording recording = describe_recording(flown, mission.assets, pile);
  RecorderSet set =
      make_recorders({flown, recording, sensors.frames(), title_of(mission, pile)}, folder.path());
  folder.expect(set.names);
  add_live_recorders(set, context.options, ros_options(flown.outputs, recording));
  RecordingQueue queue(std::move(set.recorders));
  take_samples(sensors, queue, folder, context, recorded);
  context.progress.finish(std::to_string(sensors.count_frames()) + " frames");
  for (const std::string& warning : context.warnings)
    std::fprintf(stderr, "rubble: warning: %s\n", printable(warning).c_str());

  context.progress.start("record");
  queue.finish();
  for (const std::string& name : set.names) folder.add(name);
  write_legend(mission, folder);
  folder.hash_files(context.threads());
  context.progress.finish(std::to_string(set.names.size()) + " files");
}

}  // namespace

Renderer prepare_renderer(const Scenario& scenario, const AssetLibrary& assets,
                          const PileState& pile, GlContext& gl, int threads,
                          const std::function<void(double)>& on_light) {
  RenderOptions options;
  options.threads = threads;
  options.cache_folder = DiskCache::usual_folder();
  return Renderer(gl, build_scene(scenario, assets, pile), options, on_light);
}

RecordedFrames record_frames(const ResolvedMission& mission, const PileState& pile,
                             RunFolder& folder, RunContext& context) {
  const Scenario flown = resolve_path(mission, pile, folder, context);
  context.progress.start("scene");
  GlContext gl({context.options.gl_device, context.threads()});
  RecordedFrames recorded;
  recorded.hashes = FrameHashes(names_of_cameras(flown));
  recorded.environment = describe_environment(gl.info(), context.threads());
  Renderer renderer =
      prepare_renderer(flown, mission.assets, pile, gl, context.threads(),
                       [&](double fraction) { context.progress.update(fraction, "light"); });
  SensorSuite sensors(flown, renderer, context.threads());
  context.progress.finish("ready on " + gl.info().renderer);
  record(sensors, mission, flown, pile, folder, context, recorded);
  return recorded;
}

}  // namespace rubble
