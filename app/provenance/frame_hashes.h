// A hash of every channel of every frame, so that two runs can be compared without their frames.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "render/scene/frame.h"

namespace rubble {

// XXH64 of a channel's bytes; 0: the frame has no such channel.
struct FrameHashes {
  std::vector<std::string> channels;               // "pose", "rgb", "depth", ...
  std::vector<std::vector<std::uint64_t>> frames;  // one hash per channel

  // Frames come in order, and all their channels are listed, filled or not.
  void add(const Frame& frame);
  // Without the channels that no frame has.
  FrameHashes compact() const;
};

// Where two runs part: the first frame that differs, and its first channel that does. `why` is a
// sentence; empty: they are equal.
struct FrameDifference {
  int frame = -1;
  std::string channel, why;
};
// Whether a channel is one value or more a pixel.
bool is_picture(const std::string& channel);
FrameDifference find_difference(const FrameHashes& was, const FrameHashes& is);

// "0123456789abcdef 0123...": one row of `frames`, and back (false: not that).
std::string format_hashes(const std::vector<std::uint64_t>& hashes);
bool parse_hashes(const std::string& text, std::vector<std::uint64_t>& hashes);

}  // namespace rubble
