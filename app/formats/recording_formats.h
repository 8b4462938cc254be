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

// Of several cameras, what formats that hold one camera leave is in this folder of the run, a folder
// for each: cameras/front/groundtruth.txt.
inline constexpr char kCamerasFolder[] = "cameras";

// What recorders are made from.
struct RecordingInputs {
  const Scenario& scenario;    // with the path that is flown
  const Recording& recording;  // of a format that holds one camera: with that one alone
  std::vector<int> frames;     // that will come of each camera; empty: not known
  std::string title;           // of the contact sheet
  std::size_t camera = 0;      // of a format that holds one: its number among all_cameras()
};

struct RecordingFormat {
  std::string name;        // of the key in `outputs`: "bag"
  std::string leaves;      // in the run's folder: "mission.bag", "tum"
  bool is_folder = false;  // what it leaves
  bool OutputScenario::*wanted;
  std::unique_ptr<Recorder> (*make)(const std::string& path, const RecordingInputs& inputs);
  double (*estimate)(const RecordedSize& size);  // of one camera, at most; unit: byte
  bool one_camera = false;                       // whether it holds a single camera
};

// In the order in which they take a frame. docs/development/contributing.md says how to add one.
const std::vector<RecordingFormat>& recording_formats();

// How messages of ROS hold the frames of that scenario, in files and live.
RosOptions ros_options(const OutputScenario& outputs, const Recording& recording);

}  // namespace rubble
