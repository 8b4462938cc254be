// A reconstruction in the world of its dataset, to be looked at.
#pragma once

#include <string>
#include <vector>

#include "app/eval/sfm/sfm_score.h"

namespace rubble {

// NAME_points.ply: the points with their colours and the number of their segment. NAME_track.csv: a
// row for each frame of each segment, in order of time: frame, image, segment, aligned position,
// true position, distance (unit: m). Segments that could not be aligned are left out. Throws
// RunError.
void write_sfm_details(const std::string& folder, const std::string& name,
                       const std::vector<SfmSegment>& segments, const SfmGroundTruth& truth);

}  // namespace rubble
