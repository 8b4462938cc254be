// Every recorder with the options that change what it writes, so that what must hold for all is
// tested with all.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "io/recording/recorder.h"

namespace rubble::test {

struct RecorderKind {
  std::string name;
  std::function<std::unique_ptr<Recorder>(const std::string& path)> make;
};

// total_frames: how many will be recorded. Those with every channel need make_full_frame().
std::vector<RecorderKind> all_recorders(int total_frames);

// A file's content; of a folder, the names and contents of all files in it, in order of the names.
std::string read_tree(const std::string& path);

}  // namespace rubble::test
