// The hashes of the frames of an unfinished run, one line a frame, written as they are rendered.
//
// A run that goes on renders its frames again from the first one, for the exposure of each follows
// from the ones before, and writes every recording anew: that needs no room beyond the recordings.
// The journal then shows whether the frames are those that were there before.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernel/base/system/output_files.h"

namespace rubble {

class FrameJournal {
 public:
  // Reads what an earlier attempt noted, and appends to it. A last line that was cut off by a kill
  // or a power cut does not count.
  explicit FrameJournal(const std::string& path);

  // Throws RunError when frame `index` (from 0, in order) is not the one that was noted before: the
  // graphics driver has changed in between.
  void note(std::size_t index, const std::vector<std::uint64_t>& hashes);

 private:
  AppendedFile file_;
  std::vector<std::string> lines_;
};

}  // namespace rubble
