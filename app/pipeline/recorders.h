// Which files the frames of a run go into.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/assets/asset_library.h"
#include "io/recording/recorder.h"
#include "io/recording/recording.h"
#include "io/ros/ros_recorder.h"
#include "kernel/model/pile_state.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

struct RecorderSet {
  std::vector<std::unique_ptr<Recorder>> recorders;
  std::vector<std::string> names;  // of their files or folders, relative to the run's folder
};

// What every frame of the run holds besides colour and depth, and what its numbers mean.
Recording describe_recording(const Scenario& scenario, const AssetLibrary& assets,
                             const PileState& pile);

// How messages of ROS hold the frames of that scenario, in files and live.
RosOptions ros_options(const OutputScenario& outputs, const Recording& recording);

// Those that the scenario asks for. frames: how many will come; title: of the contact sheet.
RecorderSet make_recorders(const Scenario& scenario, const Recording& recording, int frames,
                           const std::string& title, const std::string& folder);

}  // namespace rubble
