#include "app/eval/sfm/sfm_score.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "app/eval/scores/trajectory_error.h"

namespace rubble {
namespace {

// Errors of all segments together, as sums of squares.
struct Squares {
  double ate = 0, trans = 0, rot = 0;
  int positions = 0, steps = 0;
};

Vec3 centre_of(const ColmapImage& image) { return image.camera_from_world.inverse().translation; }

// The poses of a segment in the order of time, aligned, with the true ones.
std::vector<PosePair> make_pairs(const SfmSegment& segment, const SfmGroundTruth& truth,
                                 const Similarity& world_from_model) {
  std::vector<std::size_t> order(segment.frames.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return segment.frames[a] < segment.frames[b]; });
  std::vector<PosePair> pairs;
  for (const std::size_t i : order)
    pairs.push_back({world_from_model * segment.model.images[i].camera_from_world.inverse(),
                     truth.world_from_optical[std::size_t(segment.frames[i])]});
  return pairs;
}

void add_steps(const SfmSegment& segment, const SfmGroundTruth& truth, Squares& sum) {
  const auto& alignment = segment.for_positions();
  if (!alignment || segment.frames.size() < 2) return;
  const RelativeError error = calc_relative_error(make_pairs(segment, truth, *alignment), 1);
  sum.trans += error.trans_rmse * error.trans_rmse * error.steps;
  sum.rot += error.rot_rmse_deg * error.rot_rmse_deg * error.steps;
  sum.steps += error.steps;
}

}  // namespace

SfmScore calc_sfm_score(const std::vector<SfmSegment>& segments, const SfmGroundTruth& truth,
                        double bound) {
  SfmScore score;
  score.frames = int(truth.model.images.size());
  score.segments = int(segments.size());
  std::vector<bool> seen(truth.model.images.size());
  Squares sum;
  double reprojection = 0;
  for (const SfmSegment& segment : segments) {  // the largest first: a frame counts in that
    for (std::size_t i = 0; i < segment.frames.size(); ++i) {
      const std::size_t frame = std::size_t(segment.frames[i]);
      if (seen[frame]) continue;
      seen[frame] = true;
      ++score.registered;
      if (!segment.for_positions()) continue;
      const double error = distance(*segment.for_positions() * centre_of(segment.model.images[i]),
                                    truth.world_from_optical[frame].translation);
      sum.ate += error * error;
      ++sum.positions;
      if (error <= bound) ++score.on_track;
    }
    add_steps(segment, truth, sum);
    score.points += std::int64_t(segment.model.points.size());
    for (const ColmapPoint& point : segment.model.points) reprojection += point.error;
  }
  if (score.points > 0) score.reprojection = reprojection / double(score.points);
  if (sum.positions > 0) score.ate_rmse = std::sqrt(sum.ate / sum.positions);
  if (sum.steps > 0) {
    score.rpe_trans_rmse = std::sqrt(sum.trans / sum.steps);
    score.rpe_rot_rmse_deg = std::sqrt(sum.rot / sum.steps);
  }
  return score;
}

std::vector<Vec3> align_points_of(const std::vector<SfmSegment>& segments) {
  std::vector<Vec3> points;
  for (const SfmSegment& segment : segments) {
    if (!segment.by_poses) continue;
    for (const ColmapPoint& point : segment.model.points)
      points.push_back(*segment.by_poses * point.position);
  }
  return points;
}

}  // namespace rubble
