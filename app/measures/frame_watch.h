// Notices colour frames that are one even colour: mostly a camera inside a piece, or no light at all.
#pragma once

#include <string>

#include "render/scene/frame.h"

namespace rubble {

class FrameWatch {
 public:
  // True for the first even frame of a run, and then warning() says what is wrong. A frame of less
  // than 16 pixels is never even. Only colour is watched: channels may well be even.
  bool notice(const Frame& frame);
  const std::string& warning() const { return warning_; }

 private:
  std::string warning_;
};

}  // namespace rubble
