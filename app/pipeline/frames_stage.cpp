// The stage from a planned flight over a settled pile to recorded frames.
#include <memory>
#include <optional>

#include "app/control/robot_senses.h"
#include "app/measures/frame_watch.h"
#include "app/pipeline/legs.h"
#include "app/pipeline/live.h"
#include "app/pipeline/recorders.h"
#include "app/pipeline/stages.h"
#include "app/provenance/frame_hashes.h"
#include "app/scene/build_scene.h"
#include "app/sensors/camera_renderers.h"
#include "app/sensors/sensor_suite.h"
#include "app/support/drawing_device.h"
#include "app/support/print.h"
#include "app/support/stop.h"
#include "io/base/atomic_file.h"
#include "io/base/escaped_text.h"
#include "io/recording/recording_queue.h"

namespace rubble {
namespace {

// labels.csv: what the numbers of the label channel mean.
void write_legend(const std::vector<std::string>& names, RunFolder& folder) {
  std::string text = "label,name\n";
  for (std::size_t i = 0; i < names.size(); ++i) text += std::to_string(i) + "," + csv_text(names[i]) + "\n";
  write_text_file(folder.file("labels.csv"), text);
  folder.add("labels.csv");
}

std::map<std::string, std::string> describe_environment(const DeviceInfo& info, int threads) {
  std::map<std::string, std::string> out{{"device", info.name}, {"threads", std::to_string(threads)}};
  out.insert(info.details.begin(), info.details.end());
  return out;
}

void say_if_idle(DeviceKind kind, const RunOptions& options) {
  const std::string card = kind == DeviceKind::software && !options.quiet ? find_card() : "";
  if (card.empty()) return;
  print_err("note: the graphics card %s is not used: the software device draws, with the same bits on every machine. "
            "--device gl uses the card\n", card.c_str());
}

std::vector<std::string> names_of_cameras(const Scenario& scenario) {
  std::vector<std::string> names;
  for (const MountedCamera& camera : scenario.cameras)
    if (camera.named) names.push_back(camera.name);
  return names;
}

// Their channels among the hashes.
std::vector<std::string> channels_of_sensors(const Scenario& scenario) {
  std::vector<std::string> names;
  for (const SensorItem& sensor : scenario.sensors) names.push_back(sensor.name + (scans(sensor) ? "/points" : "/reading"));
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

// What there is to be seen: the settled pile, and robots, which start with the flight.
struct Seen {
  const SettledPile& pile;
  const DrivenRobots& robots;
};

// The sensors on one leg, with the scene that they see.
struct PreparedLeg {
  std::unique_ptr<CameraRenderers> renderers;
  std::unique_ptr<SensorSuite> sensors;
  std::vector<std::unique_ptr<ExactDepth>> depths;  // by camera; none: as it is drawn
};

// The scene as sensors have it while the robots are driven, when nobody knows what will move.
Scene build_felt_scene(const ResolvedMission& mission, const Seen& seen) {
  const Track& track = seen.robots.moved.track;
  return build_live_scene(mission.scenario, mission.assets, seen.pile.state, seen.robots.moved, seen.robots.start_ns,
                          [&track, start = seen.robots.start_ns](int id, std::int64_t stamp_ns) {
                            return pose_in_track(track, id, stamp_ns - start);
                          });
}

// What a function is told of colours is drawn while the robot is driven, and so is what a person sees: the recorded pictures
// are lit in the same way.
bool is_lit_live(const Scenario& scenario) {
  if (scenario.robot_run.live_light) return true;
  for (const MountedCamera& camera : scenario.cameras)
    if (is_sensed(scenario, colour_sense(camera.name))) return true;
  return false;
}

// Robots start with the flight.
Scene build_leg_scene(const Leg& leg, const ResolvedMission& mission, const Seen& seen) {
  const PileState& pile = seen.pile.state;
  const Scenario& scenario = mission.scenario;
  if (!leg.window && !seen.robots.moved.empty())
    return is_lit_live(scenario) ? build_felt_scene(mission, seen)
                                 : build_robot_scene(scenario, mission.assets, pile, seen.robots.moved, seen.robots.start_ns);
  Scene scene = leg.window ? build_moving_scene(scenario, mission.assets, pile, seen.pile.track, *leg.window, leg.zero_ns)
                           : build_scene(scenario, mission.assets, pile);
  scene.start_ns = leg.flight.start_ns;
  return scene;
}

// What a function is told of depth is measured by rays: the recorded frames of its camera have the same.
std::vector<std::unique_ptr<ExactDepth>> make_told_depths(const ResolvedMission& mission, const Seen& seen, int threads) {
  const std::vector<MountedCamera>& cameras = mission.scenario.cameras;
  std::vector<std::unique_ptr<ExactDepth>> depths(cameras.size());
  std::shared_ptr<RayWorld> world;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    // Rows of a shutter are drawn each at its own time.
    if (!is_sensed(mission.scenario, cameras[i].name) || cameras[i].camera.shutter.readout > 0) continue;
    if (!world) world = std::make_shared<RayWorld>(build_felt_scene(mission, seen));
    depths[i] = std::make_unique<ExactDepth>(cameras[i], world, threads);
  }
  return depths;
}

PreparedLeg prepare_leg(const Leg& leg, const ResolvedMission& mission, const Seen& seen,
                        const std::vector<int>& frames_before, Device& device, const RunFolder& folder,
                        RunContext& context, Taking& taking) {
  context.progress.start(leg.window ? "settling scene" : "scene");
  PreparedLeg prepared;
  const Scene scene = build_leg_scene(leg, mission, seen);
  const CameraRendering rendering{context.threads(), [&](double fraction) { context.progress.update(fraction, "light"); },
                                  [&](double fraction) { taking.report(fraction, folder, context); }};
  prepared.renderers =
      std::make_unique<CameraRenderers>(scene, mission.scenario.cameras, std::vector<std::size_t>(), device, rendering);
  const bool felt = !leg.window && !seen.robots.moved.empty();
  static const RobotReadings nothing_driven;
  std::optional<Scene> felt_scene;
  if (felt && casts_rays(mission.scenario.sensors)) felt_scene = build_felt_scene(mission, seen);
  prepared.sensors = std::make_unique<SensorSuite>(
      mission.scenario, leg.flight, SensorBegin{leg.noise_seed, frames_before, leg.window.has_value()}, felt_scene ? *felt_scene : scene,
      *prepared.renderers, context.threads(), leg.window ? nothing_driven : seen.robots.readings);
  if (felt) prepared.depths = make_told_depths(mission, seen, context.threads());
  context.progress.finish("ready on " + device.info().name + ", " + device.info().about);
  return prepared;
}

// Takes every sample of a leg in order, notes the hashes of frames, and hands it to the recorders.
void take_samples(PreparedLeg& prepared, const Scenario& scenario, const Leg& leg, FrameSinks& sinks, const RunFolder& folder,
                  RunContext& context, Taking& taking, RecordedFrames& recorded) {
  SensorSuite& sensors = *prepared.sensors;
  taking.frame = 0;
  taking.frames = sensors.count_frames();
  std::vector<std::string> carriers;
  for (const MountedCamera& camera : scenario.cameras)
    carriers.push_back(camera.ride.on() ? camera.ride.robot + "/" + camera.ride.link : "");
  DepthMetrics depth(std::move(carriers));
  throw_if_stopped(folder.path());
  while (std::optional<Sample> sample = sensors.take()) {
    if (const auto* reading = std::get_if<ImuSample>(&*sample)) {
      recorded.hashes.add_imu(*reading);
    } else if (const auto* robot = std::get_if<RobotSample>(&*sample)) {
      recorded.hashes.add_robot(*robot);
    } else if (const auto* values = std::get_if<Reading>(&*sample)) {
      recorded.hashes.add_reading(*values);
      if (values->scan) throw_if_stopped(folder.path());
    } else {
      Frame& frame = std::get<Frame>(*sample);
      if (!prepared.depths.empty() && prepared.depths[std::size_t(frame.sensor)])
        frame.depth = prepared.depths[std::size_t(frame.sensor)]->measure(frame.stamp_ns, frame.world_from_camera);
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

// Of each camera, over the first so many legs.
std::vector<int> count_frames(const std::vector<Leg>& legs, std::size_t count) {
  std::vector<int> frames(legs.front().flight.cameras.size());
  for (std::size_t leg = 0; leg < count; ++leg)
    for (std::size_t i = 0; i < frames.size(); ++i)
      frames[i] += int(legs[leg].flight.cameras[i].stamps_ns.size());
  return frames;
}

void finish_recording(const ResolvedMission& mission, const Legend& legend, const RecorderSet& set, RecordingQueue& queue,
                      RunFolder& folder, RunContext& context) {
  context.progress.start("record");
  queue.finish();
  for (const std::string& name : set.names) folder.add(name);
  if (has_channel(mission.scenario, "label")) write_legend(legend.labels, folder);
  folder.hash_files(context.threads());
  context.progress.finish(std::to_string(set.names.size()) + " files");
}

// Frames into files, until the last file is complete.
void record(const std::vector<Leg>& legs, const ResolvedMission& mission, const Seen& seen,
            Device& device, RunFolder& folder, RunContext& context, RecordedFrames& recorded) {
  const PileState& pile = seen.pile.state;
  Taking taking;
  PreparedLeg prepared = prepare_leg(legs.front(), mission, seen, {}, device, folder, context, taking);
  Recording recording = describe_recording(mission.scenario, mission.assets, pile, seen.robots.records);
  recording.mount = seen.robots.mount;
  RecorderSet set = make_recorders({mission.scenario, recording, count_frames(legs, legs.size()),
                                    recording_title(mission.provenance.script.path, mission.scenario.seed, pile)}, folder.path());
  folder.expect(set.names);
  add_live_recorders(set, context.options, ros_options(mission.scenario.outputs, recording));
  RecordingQueue queue(std::move(set.recorders));
  FrameSinks sinks{queue, FrameJournal(folder.frames_file()), {}};
  for (std::size_t i = 0; i < legs.size(); ++i) {
    if (i > 0) {
      prepared = {};  // what the leg before took on the device comes free first
      prepared = prepare_leg(legs[i], mission, seen, count_frames(legs, i), device, folder, context, taking);
    }
    context.progress.start(legs[i].window ? "settling frames" : "render");
    take_samples(prepared, mission.scenario, legs[i], sinks, folder, context, taking, recorded);
    context.progress.finish(std::to_string(prepared.sensors->count_frames()) + " frames");
  }
  finish_recording(mission, recording.legend, set, queue, folder, context);
}

}  // namespace

RecordedFrames record_frames(const ResolvedMission& mission, const SettledPile& pile,
                             const DrivenRobots& robots, const std::vector<Leg>& legs,
                             RunFolder& folder, RunContext& context) {
  const DeviceKind kind = mission.scenario.device;
  say_if_idle(kind, context.options);
  const std::unique_ptr<Device> device = open_device(kind, context.options.device, context.threads());
  RecordedFrames recorded;
  recorded.hashes = FrameHashes(names_of_cameras(mission.scenario), channels_of_sensors(mission.scenario));
  recorded.environment = describe_environment(device->info(), context.threads());
  record(legs, mission, {pile, robots}, *device, folder, context, recorded);
  return recorded;
}

}  // namespace rubble
