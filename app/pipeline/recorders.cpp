#include "app/pipeline/recorders.h"

#include <filesystem>

#include "app/fines/pile_fines.h"
#include "app/formats/class_labels.h"
#include "app/provenance/earlier_files.h"
#include "app/scene/build_scene.h"
#include "app/surroundings/pile_surroundings.h"
#include "app/victims/place_victims.h"
#include "io/recording/frame_order.h"
#include "kernel/base/hash.h"
#include "kernel/base/system/output_files.h"

namespace rubble {

namespace {

Channels channels_of(const MountedCamera& mounted) {
  Channels channels;
  channels.truth = mounted.camera.channel_set();
  channels.right = mounted.camera.stereo_baseline > 0;
  channels.measured_depth = mounted.depth_sensor.type != DepthSensorType::none;
  channels.events = mounted.event_camera.on;
  return channels;
}

CameraRecord record_of(const MountedCamera& mounted) {
  CameraRecord record;
  record.name = mounted.name;
  record.topic = mounted.topic();
  if (mounted.named) record.truth_topic = record.topic + "/ground_truth";
  record.link = mounted.name + "_link";
  record.optical = mounted.frame_id();
  record.right_optical = mounted.name + "_right_optical_frame";
  record.baseline = mounted.camera.stereo_baseline;
  record.rig_from_camera = mounted.rig_from_camera();
  record.channels = channels_of(mounted);
  return record;
}

// carried: the frame of what carries it.
ImuRecord record_of(const ImuScenario& imu, const std::string& carried) {
  ImuRecord record;
  record.name = imu.name;
  record.topic = imu.ros_topic();
  record.frame_id = imu.frame_id.value_or(imu.is_rig() ? carried : imu.name + "_link");
  record.rig_from_imu = imu.rig_from_imu();
  record.model = imu.model;
  return record;
}

// TF: of the link that carries a sensor; empty: the rig does.
std::string frame_of(const Carrier& ride, const Scenario& scenario, const std::vector<RobotRecord>& robots) {
  const std::vector<std::string> names = robot_names(scenario.robots);
  for (std::size_t i = 0; ride.on() && i < robots.size(); ++i)
    if (names[i] == ride.robot)
      return ride.link.empty() ? robots[i].frame_of(0) : robots[i].frame_named(ride.link);
  return "";
}

// Of the formats that hold one camera: into cameras/NAME/.
void add_recorders_of_cameras(const RecordingInputs& inputs, const std::string& folder,
                              RecorderSet& set) {
  remove_folder_of_killed_run(folder + "/" + kCamerasFolder);
  for (std::size_t i = 0; i < inputs.recording.cameras.size(); ++i) {
    const Recording alone = inputs.recording.of_camera(i);
    const std::string own = inputs.scenario.cameras[i].folder_in(folder);
    RecordingInputs of_camera{inputs.scenario, alone, {}, inputs.title};
    if (!inputs.frames.empty()) of_camera.frames = {inputs.frames[i]};
    of_camera.camera = i;
    for (const RecordingFormat& format : recording_formats()) {
      if (!format.one_camera || !is_wanted(format, inputs.scenario)) continue;
      make_folder_below(folder, kCamerasFolder + ("/" + alone.cameras.front().name));
      set.recorders.push_back(
          make_one_camera_recorder(int(i), find_imu_beside(inputs.recording, i), format.make(own + "/" + format.leaves, of_camera)));
      if (set.names.empty() || set.names.back() != kCamerasFolder)
        set.names.push_back(kCamerasFolder);
    }
  }
}

}  // namespace

Recording describe_recording(const Scenario& scenario, const AssetLibrary& assets,
                             const PileState& pile, const std::vector<RobotRecord>& robots) {
  Recording recording;
  // A robot's own base is called base_link.
  if (scenario.names_cameras()) recording.rig = scenario.robots.empty() ? "base_link" : "rig_link";
  recording.cameras.clear();
  recording.robots = robots;
  for (const MountedCamera& camera : scenario.cameras) {
    recording.cameras.push_back(record_of(camera));
    recording.cameras.back().carrier = frame_of(camera.ride, scenario, robots);
  }
  for (const ImuScenario& imu : scenario.imus) {
    const std::string carrier = frame_of(imu.ride, scenario, robots);
    recording.imus.push_back(record_of(imu, recording.frame_of(carrier)));
    recording.imus.back().carrier = carrier;
  }
  for (const SensorItem& sensor : scenario.sensors) {
    std::unique_ptr<SensorKind> format = sensor.figures->clone();
    format->exact = !sensor.noise;
    recording.sensors.push_back({sensor.name, topic_of(scenario.sensors, sensor), sensor.frame(), frame_of(sensor.ride, scenario, robots),
                                 sensor.carrier_from_sensor(), std::move(format)});
  }
  const ClassLabels labels(scenario, assets.types);
  recording.legend.labels = labels.names();
  for (const PieceState& piece : pile.pieces) {
    const auto type = std::size_t(piece.type);
    recording.legend.pieces.push_back(
        {labels.of_type(piece.type), assets.types[type].name});
  }
  for (const RobotRecord& robot : robots)
    for (const std::string& link : robot.instances) recording.legend.pieces.push_back({labels.of_robots(), link});
  for (const Victim& victim : find_victims(pile)) recording.legend.pieces.at(std::size_t(victim.piece)).victim = true;
  add_fines(labels, pile, recording.legend);
  add_surroundings(labels, pile, recording.legend);
  return recording;
}

std::string recording_title(const std::string& script, std::uint64_t seed, const PileState& pile) {
  return std::filesystem::path(script).stem().string() + "   seed " + std::to_string(seed) + "   " +
         std::to_string(pile.pieces.size()) + " pieces   state " + hex64(pile.state_hash());
}

RecorderSet make_recorders(const RecordingInputs& inputs, const std::string& folder) {
  RecorderSet set;
  const bool apart = inputs.scenario.names_cameras();
  for (const RecordingFormat& format : recording_formats()) {
    if (!is_wanted(format, inputs.scenario) || (apart && format.one_camera)) continue;
    const std::string path = folder + "/" + format.leaves;
    remove_folder_of_killed_run(path);
    set.names.push_back(format.leaves);
    if (!format.beside.empty()) set.names.push_back(format.beside);
    set.recorders.push_back(format.make(path, inputs));
  }
  if (apart) add_recorders_of_cameras(inputs, folder, set);
  return set;
}

}  // namespace rubble
