// Recorders turn frames into files. Each writes to "NAME.part" and renames on finish().
#pragma once

#include <string>

#include "render/scene/frame.h"

namespace rubble {

class Recorder {
 public:
  virtual ~Recorder() = default;  // without finish(): removes what it wrote
  // Frames come in order of their stamps; one dropped or out of order throws RunError.
  virtual void write(const Frame& frame) = 0;
  // Completes the files and gives them their final names.
  virtual void finish() = 0;
};

}  // namespace rubble
