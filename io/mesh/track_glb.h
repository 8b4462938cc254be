// Who moved when as a glTF animation: the pile of pile.glb, and a clip in which every piece goes the way
// of its track. Y up, as in every .glb of ours.
//
// Each piece that moves has a channel for its translation and one for its rotation, keyed where the
// track is and linear in between; a piece that is not there has the scale 0. Times of the clip are those
// of the track; unit: s.
#pragma once

#include <string>

#include "io/mesh/pile_model.h"
#include "kernel/model/track.h"

namespace rubble {

// model: pieces with their numbers, those that the pile lost, too. A piece that is not in the track
// stands still. Throws RunError when the file cannot be written.
void write_track_glb(const std::string& path, const PileModel& model, const Track& track);

}  // namespace rubble
