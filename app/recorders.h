// Which files the frames of a run go into.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/run_folder.h"
#include "io/recorder.h"
#include "scripting/scenario.h"

namespace rubble {

struct RecorderSet {
  std::vector<std::unique_ptr<Recorder>> recorders;
  std::vector<std::string> names;  // of their files or folders, relative to the run's folder
};

// Those that the scenario asks for. frames: how many will come; title: of the contact sheet.
RecorderSet make_recorders(const OutputScenario& outputs, int frames, const std::string& title,
                           const RunFolder& folder);

}  // namespace rubble
