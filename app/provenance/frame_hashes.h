// A hash of every channel of every frame, so that two runs can be compared without their frames.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "kernel/base/system/output_files.h"
#include "render/scene/frame.h"
#include "render/scene/reading.h"
#include "render/scene/robot_sample.h"

namespace rubble {

// XXH64 of a channel's bytes; 0: the frame has no such channel. Of several cameras the channels are
// called "front/rgb", and a row is a frame of one of them, in the order of stamps.
// Readings of a sensor are in a channel of the frame that follows them: "front/reading", of one that scans "top/points".
struct FrameHashes {
  // cameras: their names, of several; empty: a single camera. sensors: the channels of all of the scenario's sensors.
  explicit FrameHashes(std::vector<std::string> cameras = {}, std::vector<std::string> sensors = {})
      : cameras_(std::move(cameras)), sensors_(std::move(sensors)), values_(sensors_.size()) {}

  std::vector<std::string> channels;               // "pose", "rgb", "depth", ..., "events", "imu", "robots"; from the first frame on
  std::vector<std::vector<std::uint64_t>> frames;  // one hash per channel

  // Samples come in order, and all channels are listed, filled or not. Readings of inertial units and
  // of robots belong to the next frame.
  void add(const Frame& frame);
  void add_imu(const ImuSample& sample);
  void add_robot(const RobotSample& sample);
  void add_reading(const Reading& reading);
  // Without the channels that no frame has.
  FrameHashes compact() const;

 private:
  std::vector<std::string> cameras_, sensors_;
  std::vector<ImuSample> readings_;                // since the last frame
  std::vector<std::vector<std::uint64_t>> values_;  // likewise: of each sensor a hash of each reading
  std::vector<RobotSample> robots_;                // likewise
};

// Where two runs part: the first frame that differs, and its first channel that does. `why` is a
// sentence; empty: they are equal.
struct FrameDifference {
  int frame = -1;            // row of the first that differs; -1: none
  std::string channel, why;  // of that frame; a few words; empty: no difference
};
// Whether a channel is one value or more a pixel.
bool is_picture(const std::string& channel);
FrameDifference find_difference(const FrameHashes& was, const FrameHashes& is);

// "0123456789abcdef 0123...": one row of `frames`, and back (false: not that).
std::string format_hashes(const std::vector<std::uint64_t>& hashes);
bool parse_hashes(const std::string& text, std::vector<std::uint64_t>& hashes);

// The hashes of the frames of an unfinished run, one line a frame, written as they are rendered.
//
// A run that goes on renders its frames again from the first one, for the exposure of each follows
// from the ones before, and writes every recording anew: that needs no room beyond the recordings.
// The journal then shows whether the frames are those that were there before.
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
