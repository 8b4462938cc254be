// The table of recording formats: one row for each file or folder.
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

// With several cameras, formats that hold one camera write into this folder of the run, one folder for each camera:
// cameras/front/groundtruth.txt.
inline constexpr char kCamerasFolder[] = "cameras";

// Inputs of recorders.
struct RecordingInputs {
  const Scenario& scenario;    // with the resolved path
  const Recording& recording;  // with one camera only for a format that holds one camera
  std::vector<int> frames;     // number of frames of each camera; empty: unknown
  std::string title;           // of the contact sheet
  std::size_t camera = 0;      // for a format that holds one camera: its index in the scenario
};

// Samples that a format has a place for, beside frames.
struct HeldSamples {
  bool imus = false, scans = false, readings = false, robots = false;
  bool biases = false;  // of inertial units
};

struct RecordingFormat {
  std::string name;        // of the key in `outputs`: "bag"
  std::string leaves;      // file or folder in the run's folder: "mission.bag", "tum"
  bool is_folder = false;  // whether `leaves` is a folder
  bool OutputScenario::*wanted;
  HeldSamples holds;
  std::unique_ptr<Recorder> (*make)(const std::string& path, const RecordingInputs& inputs);
  double (*estimate)(const RecordedSize& size);  // largest size for one camera; unit: byte
  bool one_camera = false;                       // whether it holds a single camera
  bool of_sensors = false;                       // whether it is only there where a sensor gives numbers
  std::string beside{};                          // a second, small file in the run's folder: "metadata.yaml"
};

// Whether the scenario asks for it.
bool is_wanted(const RecordingFormat& format, const Scenario& scenario);

// In the order in which they receive a frame. docs/development/contributing.md describes how to add one.
const std::vector<RecordingFormat>& recording_formats();

// Throws InputError for a name that no format has.
const RecordingFormat& find_recording_format(const std::string& name);

// Options of ROS messages for this scenario, in files and live.
RosOptions ros_options(const OutputScenario& outputs, const Recording& recording);

}  // namespace rubble
