// What every recorder demands of its frames.
#pragma once

#include <cstdint>
#include <string>

#include "render/frame.h"

namespace rubble {

// Throws RunError for a frame that was dropped, came out of order, has a stamp that does not grow,
// or whose pictures do not have the size that its intrinsics say.
class FrameOrder {
 public:
  explicit FrameOrder(std::string recorder) : recorder_(std::move(recorder)) {}
  void check(const Frame& frame);
  int count() const { return count_; }  // frames accepted so far

 private:
  std::string recorder_;  // for messages
  int count_ = 0;
  std::int64_t last_stamp_ns_ = 0;
};

}  // namespace rubble
