// How far an estimated trajectory is from the true one, by the definitions of the program evo.
#pragma once

#include <vector>

#include "app/eval/scores/trajectory_file.h"

namespace rubble {

struct PosePair {
  Pose estimate, truth;  // world_from_body of the same instant; unit: m
  double stamp = 0;      // of the truth; unit: s
};

// Each pose of the shorter trajectory with the one of the longer that is nearest in time, if that
// is within max_difference (unit: s); in order of time.
std::vector<PosePair> associate(const std::vector<StampedPose>& estimate,
                                const std::vector<StampedPose>& truth, double max_difference);

// Of the distances after a rigid alignment; unit: m.
struct ErrorSpread {
  double mean = 0, median = 0, max = 0;
};

struct TrajectoryError {
  int pairs = 0;  // poses that were compared
  // Absolute trajectory error: root mean square distance of positions after a least-squares
  // alignment of the estimate, rigid (SE3) or with scale (Sim3); unit: m.
  double ate_rmse_se3 = 0, ate_rmse_sim3 = 0;
  ErrorSpread ate_se3;
  double sim3_scale = 1;  // by which the estimate is multiplied
  // Relative pose error, not aligned, between poses `delta` pairs apart (0 and delta, delta and 2
  // delta, ...): root mean square of the norm of the translation and of the angle.
  double rpe_trans_rmse = 0;    // unit: m
  double rpe_rot_rmse_deg = 0;  // unit: degree
};

// The relative part of it alone: of the steps 0 to delta, delta to 2 delta, ...
struct RelativeError {
  int steps = 0;            // of `delta` pairs each
  double trans_rmse = 0;    // unit: m
  double rot_rmse_deg = 0;  // unit: degree
};

// delta: >= 1, fewer than the pairs.
RelativeError calc_relative_error(const std::vector<PosePair>& pairs, int delta);

// The errors of KITTI's odometry benchmark: of segments of the truth that are `length` long, from every tenth pose on,
// the relative error divided by the length, on average (Geiger, Lenz and Urtasun 2012, its development kit).
struct SegmentError {
  double length = 0;         // unit: m
  int segments = 0;          // that were found; 0: the track is shorter, and the errors are 0
  double trans_percent = 0;  // unit: %
  double rot_deg_per_m = 0;  // unit: degree/m
};
SegmentError calc_segment_error(const std::vector<PosePair>& pairs, double length);

// A pair after the rigid alignment of all.
struct AlignedPair {
  double stamp = 0;      // unit: s
  Vec3 estimate, truth;  // unit: m
};
std::vector<AlignedPair> align_pairs(const std::vector<PosePair>& pairs);

// delta: >= 1, fewer than the pairs. Throws InputError: fewer than 3 pairs, or positions all on one
// line, which leave the alignment undetermined.
TrajectoryError calc_trajectory_error(const std::vector<PosePair>& pairs, int delta = 1);

}  // namespace rubble
