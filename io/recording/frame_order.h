// What every recorder demands of its frames.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "io/recording/recorder.h"
#include "io/recording/recording.h"

namespace rubble {

// Throws RunError for a frame that was dropped, came out of order, has a stamp that does not grow
// or leaves a gap within a sequence, lacks a channel of the recording, or whose pictures do not have the
// size that its intrinsics say. Each camera has frames and a rate of its own; stamps of all never go back.
class FrameOrder {
 public:
  // Of one camera.
  explicit FrameOrder(std::string recorder, const Channels& channels = {})
      : FrameOrder(std::move(recorder), std::vector<Channels>{channels}) {}
  // Of each camera, what its frames must have.
  FrameOrder(std::string recorder, const std::vector<Channels>& channels);
  void check(const Frame& frame);
  int count() const { return count_; }  // frames accepted so far

 private:
  struct Camera {
    Channels channels;
    int count = 0;
    std::int64_t last_stamp_ns = 0;
    std::int64_t period_ns = 0;  // between the first two frames of the sequence; 0: not known yet
  };
  static void check_stamp(const Frame& frame, Camera& camera, const std::string& where);

  std::string recorder_;  // for messages
  std::vector<Camera> cameras_;
  int count_ = 0;
  std::int64_t latest_ns_ = 0;  // of all
};

// The channels of each camera.
std::vector<Channels> channels_of(const Recording& recording);

// For formats that hold a single camera: of several, each gets a recorder of its own.
// Passes on the frames of that camera, and the readings of one inertial unit beside it (negative: of none).
std::unique_ptr<Recorder> make_one_camera_recorder(int camera, int imu, std::unique_ptr<Recorder> recorder);
// The first inertial unit that the same carrier has as the camera; -1: none.
int find_imu_beside(const Recording& recording, std::size_t camera);

}  // namespace rubble
