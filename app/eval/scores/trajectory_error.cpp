#include "app/eval/scores/trajectory_error.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "app/eval/scores/alignment.h"
#include "kernel/base/error.h"
#include "kernel/base/quick_math.h"

namespace rubble {
namespace {

// The pose nearest in time; of two equally near the earlier.
std::size_t find_nearest(const std::vector<StampedPose>& poses, double stamp) {
  const auto after = std::lower_bound(poses.begin(), poses.end(), stamp,
                                      [](const StampedPose& p, double s) { return p.stamp < s; });
  if (after == poses.begin()) return 0;
  const std::size_t i = std::size_t(after - poses.begin());
  if (after == poses.end()) return i - 1;
  return stamp - poses[i - 1].stamp <= poses[i].stamp - stamp ? i - 1 : i;
}

double root_mean_square(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v * v;
  return std::sqrt(sum / double(values.size()));
}

std::vector<double> calc_distances(const std::vector<PosePair>& pairs, const Similarity& aligned) {
  std::vector<double> errors;
  for (const PosePair& pair : pairs)
    errors.push_back(distance(aligned * pair.estimate.translation, pair.truth.translation));
  return errors;
}

// The median of an even number is the mean of the two in the middle.
ErrorSpread calc_spread(std::vector<double> errors) {
  ErrorSpread spread;
  for (const double error : errors) spread.mean += error / double(errors.size());
  std::sort(errors.begin(), errors.end());
  spread.median = (errors[(errors.size() - 1) / 2] + errors[errors.size() / 2]) / 2;
  spread.max = errors.back();
  return spread;
}

double angle_deg(const Quat& q) {
  const double sine = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z);
  return 2 * quick::atan2(sine, std::abs(q.w)) * 180 / 3.14159265358979323846;
}

Similarity align(const std::vector<PosePair>& pairs, bool with_scale) {
  std::vector<Vec3> from, to;
  for (const PosePair& pair : pairs) {
    from.push_back(pair.estimate.translation);
    to.push_back(pair.truth.translation);
  }
  const auto found = align_for_distances(from, to, with_scale);
  if (!found)
    throw InputError({"", 0, "", "the positions are all at one place", "a track that moves",
                                            std::to_string(pairs.size()) + " pairs", ""});
  return *found;
}

}  // namespace

std::vector<PosePair> associate(const std::vector<StampedPose>& estimate,
                                const std::vector<StampedPose>& truth, double max_difference) {
  const bool truth_is_longer = truth.size() > estimate.size();
  const auto& shorter = truth_is_longer ? estimate : truth;
  const auto& longer = truth_is_longer ? truth : estimate;
  std::vector<PosePair> pairs;
  for (const StampedPose& pose : shorter) {
    const StampedPose& other = longer[find_nearest(longer, pose.stamp)];
    if (std::abs(other.stamp - pose.stamp) > max_difference) continue;
    const Pose &a = pose.world_from_body, &b = other.world_from_body;
    pairs.push_back(truth_is_longer ? PosePair{a, b, other.stamp} : PosePair{b, a, pose.stamp});
  }
  return pairs;
}

RelativeError calc_relative_error(const std::vector<PosePair>& pairs, int delta) {
  RelativeError error;
  std::vector<double> lengths, angles;
  for (std::size_t i = 0; i + std::size_t(delta) < pairs.size(); i += std::size_t(delta)) {
    const PosePair &a = pairs[i], &b = pairs[i + std::size_t(delta)];
    const Pose truth = a.truth.inverse() * b.truth, estimate = a.estimate.inverse() * b.estimate;
    const Pose difference = truth.inverse() * estimate;
    lengths.push_back(norm(difference.translation));
    angles.push_back(angle_deg(difference.rotation));
  }
  error.trans_rmse = root_mean_square(lengths);
  error.rot_rmse_deg = root_mean_square(angles);
  error.steps = int(lengths.size());
  return error;
}

SegmentError calc_segment_error(const std::vector<PosePair>& pairs, double length) {
  constexpr std::size_t kStep = 10;
  std::vector<double> way{0};
  for (std::size_t i = 1; i < pairs.size(); ++i)
    way.push_back(way.back() + distance(pairs[i - 1].truth.translation, pairs[i].truth.translation));
  SegmentError error;
  error.length = length;
  for (std::size_t first = 0; first < pairs.size(); first += kStep) {
    const auto after = std::upper_bound(way.begin() + long(first), way.end(), way[first] + length);
    if (after == way.end()) break;
    const PosePair &a = pairs[first], &b = pairs[std::size_t(after - way.begin())];
    const Pose difference = (a.estimate.inverse() * b.estimate).inverse() * (a.truth.inverse() * b.truth);
    error.trans_percent += 100 * norm(difference.translation) / length;
    error.rot_deg_per_m += angle_deg(difference.rotation) / length;
    ++error.segments;
  }
  if (error.segments == 0) return error;
  error.trans_percent /= error.segments;
  error.rot_deg_per_m /= error.segments;
  return error;
}

std::vector<AlignedPair> align_pairs(const std::vector<PosePair>& pairs) {
  const Similarity aligned = align(pairs, false);
  std::vector<AlignedPair> all;
  for (const PosePair& pair : pairs) all.push_back({pair.stamp, aligned * pair.estimate.translation, pair.truth.translation});
  return all;
}

TrajectoryError calc_trajectory_error(const std::vector<PosePair>& pairs, int delta) {
  if (pairs.size() < 3)
    throw InputError({"", 0, "", "too few poses have a partner in time", "at least 3",
                      std::to_string(pairs.size()), ""});
  if (delta < 1 || std::size_t(delta) >= pairs.size())
    throw InputError({"", 0, "--delta", "out of range", "1 to " + std::to_string(pairs.size() - 1),
                      std::to_string(delta), ""});
  TrajectoryError error;
  error.pairs = int(pairs.size());
  const std::vector<double> distances = calc_distances(pairs, align(pairs, false));
  error.ate_rmse_se3 = root_mean_square(distances);
  error.ate_se3 = calc_spread(distances);
  const Similarity similarity = align(pairs, true);
  error.sim3_scale = similarity.scale;
  error.ate_rmse_sim3 = root_mean_square(calc_distances(pairs, similarity));
  const RelativeError relative = calc_relative_error(pairs, delta);
  error.rpe_trans_rmse = relative.trans_rmse;
  error.rpe_rot_rmse_deg = relative.rot_rmse_deg;
  return error;
}

}  // namespace rubble
