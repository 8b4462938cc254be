// Every file or folder that the frames of a run can be recorded into: one row a format.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/formats/recorded_size.h"
#include "io/recording/recorder.h"
#include "io/recording/recording.h"
#include "io/ros/ros_recorder.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

// What recorders are made from. frames: how many will come; title: of the contact sheet.
struct RecordingInputs {
  const Scenario& scenario;    // with the path that is flown
  const Recording& recording;  // what every frame holds
  int frames = 0;              // 0: not known
  std::string title;           // of the contact sheet
};

struct RecordingFormat {
  std::string name;        // of the key in `outputs`: "bag"
  std::string leaves;      // in the run's folder: "mission.bag", "tum"
  bool is_folder = false;  // what it leaves
  bool OutputScenario::*wanted;
  std::unique_ptr<Recorder> (*make)(const std::string& path, const RecordingInputs& inputs);
  double (*estimate)(const RecordedSize& size);  // of what it leaves, at most; unit: byte
};

// In the order in which they take a frame. docs/contributing.md says how to add one.
const std::vector<RecordingFormat>& recording_formats();

// How messages of ROS hold the frames of that scenario, in files and live.
RosOptions ros_options(const OutputScenario& outputs, const Recording& recording);

}  // namespace rubble
