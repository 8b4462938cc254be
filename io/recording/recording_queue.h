// Recorders off the rendering thread.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "io/recording/recorder.h"

namespace rubble {

// Feeds every sample, in order, to every recorder, each on a thread of its own. What a recorder
// writes does not depend on the timing of the others.
//
// A recorder that throws stops the recording: no recorder is finished, and the next push() or
// finish() throws what it threw (of several: the first in the order of the recorders).
class RecordingQueue {
 public:
  // capacity: frames held at most before push() waits, >= 1; a frame of 1024x1024 is 7 MB.
  explicit RecordingQueue(std::vector<std::unique_ptr<Recorder>> recorders,
                          std::size_t capacity = 6);
  ~RecordingQueue();  // without finish(): stops, and the recorders remove what they wrote
  RecordingQueue(const RecordingQueue&) = delete;
  RecordingQueue& operator=(const RecordingQueue&) = delete;

  // Waits while the slowest recorder is `capacity` frames behind. Throws RunError, and gives the sample
  // to no recorder, when a number in it that must be finite is not: pose, velocity, intrinsics,
  // exposure, and what the inertial unit measures. (NaN in a depth image says that nothing is there.)
  void push(Sample sample);
  // Waits until every recorder has every frame, then finishes them all. No push() afterwards.
  void finish();

 private:
  struct Shared;
  std::unique_ptr<Shared> shared_;
};

}  // namespace rubble
