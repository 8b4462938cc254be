// Which files the frames of a run go into.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/assets/asset_library.h"
#include "app/formats/recording_formats.h"
#include "io/recording/recorder.h"
#include "io/recording/recording.h"
#include "kernel/model/pile_state.h"
#include "kernel/model/robot.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

struct RecorderSet {
  std::vector<std::unique_ptr<Recorder>> recorders;  // each is given every sample
  std::vector<std::string> names;                    // of their files or folders, relative to the run's folder
};

// Every sensor of the run, what it gives and under which names, and what numbers mean. robots: those of the
// scenario, in their order.
Recording describe_recording(const Scenario& scenario, const AssetLibrary& assets,
                             const PileState& pile, const std::vector<RobotRecord>& robots = {});

// The links of a robot with the class of robots, whose numbers follow those of the pieces and of the robots before it.
void add_links(const RobotModel& robot, std::uint16_t label, Legend& legend);

// What the contact sheet says at its top.
std::string recording_title(const std::string& script, std::uint64_t seed, const PileState& pile);

// Those of recording_formats() that the scenario asks for. Of several cameras, formats that hold one
// have a recorder for each, in cameras/NAME/.
RecorderSet make_recorders(const RecordingInputs& inputs, const std::string& folder);

}  // namespace rubble
