// Signs that two trajectories that were paired do not belong together.
#pragma once

#include <string>
#include <vector>

#include "app/eval/scores/trajectory_error.h"
#include "app/eval/scores/trajectory_file.h"

namespace rubble {

// Two files with their names, as they were read.
struct ComparedTracks {
  std::string estimate_path, truth_path;
  RecordedTrajectory estimate, truth;
};

// Throws InputError for tracks that cannot be paired: stamps in one file only, numbers of poses that
// differ without stamps, no orientations, all stamps within max_difference of each other.
void check_comparable(const ComparedTracks& tracks, double max_difference);

// Why no pose has a partner, by the stamps' sizes; empty: nothing is known.
std::string explain_no_overlap(const ComparedTracks& tracks);

// For the user: fewer than half of the poses of the shorter have a partner; the orientations differ by
// one large turn, as between an optical frame and a body's.
std::vector<std::string> find_doubts(const ComparedTracks& tracks, const std::vector<PosePair>& pairs);

}  // namespace rubble
