// What every recorder demands of its frames.
#pragma once

#include <cstdint>
#include <string>

#include "io/recording/recording.h"

namespace rubble {

// Throws RunError for a frame that was dropped, came out of order, has a stamp that does not grow
// or leaves a gap within a sequence, lacks a channel of the recording, or whose pictures do not have the size that
// its intrinsics say.
class FrameOrder {
 public:
  explicit FrameOrder(std::string recorder, const Channels& channels = {})
      : recorder_(std::move(recorder)), channels_(channels) {}
  void check(const Frame& frame);
  int count() const { return count_; }  // frames accepted so far

 private:
  void check_stamp(const Frame& frame, const std::string& where);

  std::string recorder_;  // for messages
  Channels channels_;
  int count_ = 0;
  std::int64_t last_stamp_ns_ = 0;
  std::int64_t period_ns_ = 0;  // between the first two frames of the sequence; 0: not known yet
};

}  // namespace rubble
