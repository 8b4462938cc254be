#include "app/pipeline/recorders.h"

#include <filesystem>

#include "app/pipeline/build_scene.h"
#include "io/datasets/colmap_recorder.h"
#include "io/datasets/euroc_recorder.h"
#include "io/datasets/frames_recorder.h"
#include "io/datasets/tum_recorder.h"
#include "io/mrpt/rawlog_recorder.h"
#include "io/mrpt/simplemap_recorder.h"
#include "io/recording/contact_sheet.h"
#include "io/ros/mcap_recorder.h"
#include "io/ros/rosbag_recorder.h"
#include "render/camera/lens.h"

namespace rubble {
namespace {

SimplemapOptions simplemap_options(const Scenario& scenario, const Recording& recording) {
  SimplemapOptions options;
  options.recording = recording;
  const auto lens = std::make_shared<const Lens>(scenario.camera.intrinsics());
  options.ray = [lens](double u, double v) { return lens->direction(u, v); };
  return options;
}

ContactSheetOptions sheet_options(int frames, const std::string& title) {
  ContactSheetOptions sheet;
  sheet.total_frames = frames;
  sheet.title = title;
  return sheet;
}

}  // namespace

RosOptions ros_options(const OutputScenario& outputs, const Recording& recording) {
  RosOptions ros;
  ros.recording = recording;
  if (outputs.depth == DepthEncoding::metres) ros.depth = RosDepth::metres;
  if (outputs.pictures == PictureEncoding::png) ros.pictures = RosPictures::png;
  if (outputs.pictures == PictureEncoding::jpeg) ros.pictures = RosPictures::jpeg;
  return ros;
}

Recording describe_recording(const Scenario& scenario, const AssetLibrary& assets,
                             const PileState& pile) {
  Recording recording;
  const ChannelSet asked = scenario.camera.channel_set();
  Channels& channels = recording.channels;
  channels.normals = asked.normals;
  channels.instance = asked.instance;
  channels.label = asked.label;
  channels.flow = asked.flow;
  channels.sky_visibility = asked.sky_visibility;
  channels.right = scenario.camera.stereo_baseline > 0;
  channels.measured_depth = scenario.depth_sensor.type != DepthSensorType::none;
  channels.events = scenario.event_camera.on;
  channels.imu = scenario.imu.on;
  recording.imu = scenario.imu.model;
  recording.legend.labels = label_names(assets);
  for (const PieceState& piece : pile.pieces) {
    const auto type = std::size_t(piece.type);
    recording.legend.pieces.push_back(
        {std::uint16_t(kFirstAssetLabel + piece.type), assets.types[type].name});
  }
  return recording;
}

RecorderSet make_recorders(const Scenario& scenario, const Recording& recording, int frames,
                           const std::string& title, const std::string& folder) {
  const OutputScenario& outputs = scenario.outputs;
  RecorderSet set;
  const auto add = [&](bool wanted, const char* name, const auto& make) {
    if (!wanted) return;
    // What a run that was killed had finished is made anew: files are replaced, folders must go.
    const std::string path = folder + "/" + name;
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) std::filesystem::remove_all(path, ignored);
    set.names.push_back(name);
    set.recorders.push_back(make(path));
  };
  using Path = const std::string&;
  const RosOptions ros = ros_options(outputs, recording);
  const RawlogOptions rawlog{outputs.rawlog_gzip, 0.001, recording};
  add(outputs.rawlog, "mission.rawlog", [&](Path p) { return make_rawlog_recorder(p, rawlog); });
  add(outputs.simplemap, "mission.simplemap",
      [&](Path p) { return make_simplemap_recorder(p, simplemap_options(scenario, recording)); });
  add(outputs.bag, "mission.bag", [&](Path p) { return make_rosbag_recorder(p, ros); });
  add(outputs.mcap, "mission.mcap", [&](Path p) { return make_mcap_recorder(p, ros); });
  add(outputs.groundtruth, "groundtruth.txt",
      [](Path p) { return make_tum_trajectory_recorder(p); });
  add(outputs.tum, "tum", [&](Path p) { return make_tum_recorder(p, recording); });
  add(outputs.euroc, "euroc", [&](Path p) { return make_euroc_recorder(p, recording); });
  add(outputs.colmap, "colmap", [&](Path p) { return make_colmap_recorder(p, recording); });
  add(outputs.frames, "frames", [&](Path p) { return make_frames_recorder(p, recording); });
  add(outputs.preview, "preview.png",
      [&](Path p) { return make_contact_sheet_recorder(p, sheet_options(frames, title)); });
  return set;
}

}  // namespace rubble
