#include "app/pipeline/recorders.h"

#include <filesystem>

#include "app/pipeline/build_scene.h"

namespace rubble {

Recording describe_recording(const Scenario& scenario, const AssetLibrary& assets,
                             const PileState& pile) {
  Recording recording;
  Channels& channels = recording.channels;
  channels.truth = scenario.camera.channel_set();
  channels.right = scenario.camera.stereo_baseline > 0;
  channels.measured_depth = scenario.depth_sensor.type != DepthSensorType::none;
  channels.events = scenario.event_camera.on;
  channels.imu = scenario.imu.on;
  recording.imu = scenario.imu.model;
  recording.legend.labels = label_names(scenario, assets);
  for (const PieceState& piece : pile.pieces) {
    const auto type = std::size_t(piece.type);
    recording.legend.pieces.push_back(
        {std::uint16_t(kFirstAssetLabel + piece.type), assets.types[type].name});
  }
  return recording;
}

RecorderSet make_recorders(const RecordingInputs& inputs, const std::string& folder) {
  RecorderSet set;
  for (const RecordingFormat& format : recording_formats()) {
    if (!(inputs.scenario.outputs.*format.wanted)) continue;
    // What a run that was killed had finished is made anew: files are replaced, folders must go.
    const std::string path = folder + "/" + format.leaves;
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) std::filesystem::remove_all(path, ignored);
    set.names.push_back(format.leaves);
    set.recorders.push_back(format.make(path, inputs));
  }
  return set;
}

}  // namespace rubble
