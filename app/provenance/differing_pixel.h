// Where in a picture two recordings of a run differ.
#pragma once

#include <set>
#include <string>

#include "app/provenance/frame_hashes.h"

namespace rubble {

// "; ..." for the end of a sentence on a frame that differs: the pixel, or why none is known; empty: the frame differs in
// another channel than a picture. was: the hashes of the first run, whose rows tell which of its camera's frames this is.
// altered: recorded files that do not count. A manifest holds hashes of frames alone; the recordings hold the frames.
std::string describe_pixel(const FrameDifference& apart, const FrameHashes& was, const std::string& folder_was,
                           const std::string& folder_is, const std::set<std::string>& altered = {});

}  // namespace rubble
