// The stage from a settled pile, and its track, to recorded frames.
#include <cstdio>
#include <filesystem>
#include <memory>

#include "app/pipeline/build_scene.h"
#include "app/measures/frame_watch.h"
#include "app/pipeline/legs.h"
#include "app/pipeline/live.h"
#include "app/pipeline/recorders.h"
#include "app/pipeline/stages.h"
#include "app/planning/camera_inside.h"
#include "app/planning/flight.h"
#include "app/provenance/frame_journal.h"
#include "app/sensors/build_camera.h"
#include "app/sensors/sensor_suite.h"
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
  const std::vector<std::string> names = label_names(mission.scenario, mission.assets);
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

// Which frame of a leg is being taken, and of how many: an image that takes minutes reports on its way.
struct Taking {
  int frame = 0, frames = 1;

  void report(double of_image, const RunFolder& folder, RunContext& context) const {
    throw_if_stopped(folder.path());
    context.progress.update((frame + of_image) / frames, "frame " + std::to_string(frame + 1) + " of " +
                                                             std::to_string(frames));
  }
};

// What goes on from leg to leg: where frames go, and what is noted of them.
struct FrameSinks {
  RecordingQueue& queue;
  FrameJournal journal;
  FrameWatch watch;
  int frames = 0;  // so far
};

// Takes every sample of a leg in order, notes the hashes of frames, and hands it to the recorders.
void take_samples(SensorSuite& sensors, const Leg& leg, FrameSinks& sinks, const RunFolder& folder,
                  RunContext& context, Taking& taking, RecordedFrames& recorded) {
  taking.frame = 0;
  taking.frames = sensors.count_frames();
  DepthMetrics depth;
  throw_if_stopped(folder.path());
  while (std::optional<Sample> sample = sensors.take()) {
    if (const auto* reading = std::get_if<ImuSample>(&*sample)) {
      recorded.hashes.add_imu(*reading);
    } else if (const auto* robot = std::get_if<RobotSample>(&*sample)) {
      recorded.hashes.add_robot(*robot);
    } else {
      const Frame& frame = std::get<Frame>(*sample);
      recorded.hashes.add(frame);
      sinks.journal.note(std::size_t(sinks.frames++), recorded.hashes.frames.back());
      depth.add(frame);
      if (sinks.watch.notice(frame)) context.warnings.push_back(sinks.watch.warning());
      ++taking.frame;
      context.progress.update(double(taking.frame) / taking.frames,
                              "frame " + std::to_string(taking.frame) + " of " +
                                  std::to_string(taking.frames));
      throw_if_stopped(folder.path());
    }
    sinks.queue.push(*std::move(sample));
  }
  if (!leg.window) depth.add_to(recorded.metrics);
}

// A mistake that shows only when there is a pile, with the line of its key.
template <typename Plan>
auto with_lines_of_script(const ResolvedMission& mission, const Plan& plan) {
  try {
    return plan();
  } catch (const InputError& error) {
    const SourceFile& script = mission.provenance.script;
    std::vector<Diagnostic> mistakes = error.diagnostics();
    locate(mistakes, script.path, SourceMap(script.text, "mission"));
    throw InputError(std::move(mistakes));
  }
}

FlightPlan plan_flight(const ResolvedMission& mission, const PileState& pile,
                       const RunFolder& folder, RunContext& context) {
  return with_lines_of_script(mission, [&] {
    return resolve_flight(mission.scenario, mission.assets, pile, context.threads(),
                          [&](double done, const std::string& what) {
                            throw_if_stopped(folder.path());
                            context.progress.update(done, what);
                          });
  });
}

void warn_of_cameras_inside(const ResolvedMission& mission, const Scenario& flown,
                            const PileState& pile, const std::shared_ptr<const MotionPath>& ride,
                            RunContext& context) {
  for (const MountedCamera& camera : all_cameras(flown)) {
    std::vector<Vec3> positions;
    for (const Pose& pose : build_flight(flown, camera, ride).world_from_camera)
      positions.push_back(pose.translation);
    const auto warning = find_camera_inside(mission.assets, pile, positions);
    if (!warning) continue;
    const std::string who = flown.cameras.empty() ? "" : "camera `" + camera.name + "`: ";
    context.warnings.push_back(who + *warning);
  }
}

// The scenario with what its trajectory depends on besides the script: places in voids, ways around
// the pile. flight.json holds it.
Scenario resolve_path(const ResolvedMission& mission, const PileState& pile,
                      const std::shared_ptr<const MotionPath>& ride, RunFolder& folder,
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
  warn_of_cameras_inside(mission, flown, pile, ride, context);
  return flown;
}

RenderOptions render_options(const Scenario& scenario, int threads,
                             const std::function<void(double)>& on_image) {
  RenderOptions options;
  options.threads = threads;
  options.colour = all_cameras(scenario).front().camera.colour;
  options.image_progress = on_image;
  options.cache_folder = DiskCache::usual_folder();
  return options;
}

// The sensors on one leg, with the scene that they see.
struct PreparedLeg {
  std::unique_ptr<Renderer> renderer;
  std::unique_ptr<SensorSuite> sensors;
};

// What there is to be seen: the settled pile, and robots, which start with the flight.
struct Seen {
  const SettledPile& pile;
  const DrivenRobots& robots;
};

Scene build_leg_scene(const Leg& leg, const ResolvedMission& mission, const Seen& seen) {
  const PileState& pile = seen.pile.state;
  if (leg.window) {
    return build_moving_scene(leg.scenario, mission.assets, pile, seen.pile.track, *leg.window,
                              leg.zero_ns);
  }
  if (seen.robots.moved.empty()) return build_scene(leg.scenario, mission.assets, pile);
  return build_robot_scene(leg.scenario, mission.assets, pile, seen.robots.moved,
                           leg.scenario.start_ns);
}

PreparedLeg prepare_leg(const Leg& leg, const ResolvedMission& mission, const Seen& seen,
                        int frames_before, GlContext& gl, const RunFolder& folder,
                        RunContext& context, Taking& taking) {
  const std::string stage = leg.window ? "settling scene" : "scene";
  context.progress.start(stage);
  const Scene scene = build_leg_scene(leg, mission, seen);
  PreparedLeg prepared;
  prepared.renderer = std::make_unique<Renderer>(
      gl, scene,
      render_options(leg.scenario, context.threads(),
                     [&](double fraction) { taking.report(fraction, folder, context); }),
      [&](double fraction) { context.progress.update(fraction, "light"); });
  prepared.sensors = std::make_unique<SensorSuite>(
      leg.scenario, SensorBegin{leg.noise_seed, frames_before}, *prepared.renderer,
      context.threads(), seen.robots.readings);
  context.progress.finish("ready on " + gl.info().renderer);
  return prepared;
}

// Of each camera, over all legs.
std::vector<int> count_frames(const std::vector<Leg>& legs,
                              const std::shared_ptr<const MotionPath>& ride) {
  std::vector<int> frames;
  for (const Leg& leg : legs) {
    const std::vector<MountedCamera> cameras = all_cameras(leg.scenario);
    frames.resize(cameras.size());
    for (std::size_t i = 0; i < cameras.size(); ++i)
      frames[i] += int(build_flight(leg.scenario, cameras[i], ride).stamps_ns.size());
  }
  return frames;
}

void finish_recording(const ResolvedMission& mission, const RecorderSet& set, RecordingQueue& queue,
                      RunFolder& folder, RunContext& context) {
  for (const std::string& warning : context.warnings)
    std::fprintf(stderr, "rubble: warning: %s\n", printable(warning).c_str());
  context.progress.start("record");
  queue.finish();
  for (const std::string& name : set.names) folder.add(name);
  write_legend(mission, folder);
  folder.hash_files(context.threads());
  context.progress.finish(std::to_string(set.names.size()) + " files");
}

// Links follow the pieces, as their numbers do.
void add_robots(const DrivenRobots& robots, std::uint16_t label, Recording& recording) {
  recording.robots = robots.records;
  recording.mount = robots.mount;
  for (const RobotModel& model : robots.moved.models)
    for (const RobotLink& link : model.links)
      recording.legend.pieces.push_back({label, model.name + "/" + link.name});
}

// Frames into files, until the last file is complete. flown: as the mission, with its path.
void record(const std::vector<Leg>& legs, const ResolvedMission& mission, const Scenario& flown,
            const Seen& seen, GlContext& gl, RunFolder& folder, RunContext& context,
            RecordedFrames& recorded) {
  const PileState& pile = seen.pile.state;
  Taking taking;
  PreparedLeg prepared = prepare_leg(legs.front(), mission, seen, 0, gl, folder, context, taking);
  Recording recording = describe_recording(flown, mission.assets, pile);
  add_robots(seen.robots, std::uint16_t(kFirstAssetLabel + mission.assets.types.size()), recording);
  RecorderSet set = make_recorders(
      {flown, recording, count_frames(legs, seen.robots.readings.ride), title_of(mission, pile)}, folder.path());
  folder.expect(set.names);
  add_live_recorders(set, context.options, ros_options(flown.outputs, recording));
  RecordingQueue queue(std::move(set.recorders));
  FrameSinks sinks{queue, FrameJournal(folder.frames_file()), {}};
  for (std::size_t i = 0; i < legs.size(); ++i) {
    if (i > 0) {
      prepared = {};  // what the leg before took on the device comes free first
      prepared = prepare_leg(legs[i], mission, seen, sinks.frames, gl, folder, context, taking);
    }
    context.progress.start(legs[i].window ? "settling frames" : "render");
    take_samples(*prepared.sensors, legs[i], sinks, folder, context, taking, recorded);
    context.progress.finish(std::to_string(prepared.sensors->count_frames()) + " frames");
  }
  finish_recording(mission, set, queue, folder, context);
}

}  // namespace

Renderer prepare_renderer(const Scenario& scenario, const AssetLibrary& assets,
                          const PileState& pile, GlContext& gl, int threads,
                          const std::function<void(double)>& on_light,
                          const std::function<void(double)>& on_image) {
  return Renderer(gl, build_scene(scenario, assets, pile),
                  render_options(scenario, threads, on_image), on_light);
}

RecordedFrames record_frames(const ResolvedMission& mission, const SettledPile& pile,
                             const DrivenRobots& robots, RunFolder& folder, RunContext& context) {
  const Scenario flown = resolve_path(mission, pile.state, robots.readings.ride, folder, context);
  const std::vector<Leg> legs =
      with_lines_of_script(mission, [&] { return plan_legs(flown, pile.track); });
  GlContext gl({context.options.gl_device, context.threads()});
  RecordedFrames recorded;
  recorded.hashes = FrameHashes(names_of_cameras(flown));
  recorded.environment = describe_environment(gl.info(), context.threads());
  record(legs, mission, flown, {pile, robots}, gl, folder, context, recorded);
  return recorded;
}

}  // namespace rubble
