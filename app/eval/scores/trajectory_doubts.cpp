#include "app/eval/scores/trajectory_doubts.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/eval/scores/alignment.h"
#include "kernel/base/error.h"
#include "kernel/base/quick_math.h"

namespace rubble {
namespace {

constexpr double kLeastShare = 0.5;    // of poses that have a partner, below which the user is told
constexpr double kLargestTurn = 30;    // between two files of one frame; unit: degree
constexpr double kLargestSpread = 10;  // of a turn that counts as one and the same; unit: degree

double turn_deg(const Quat& q) {
  const double sine = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z);
  return 2 * quick::atan2(sine, std::abs(q.w)) * 180 / 3.14159265358979323846;
}

double span_seconds(const RecordedTrajectory& track) { return track.poses.back().stamp - track.poses.front().stamp; }

std::string seconds(double value) {
  char text[64];
  std::snprintf(text, sizeof text, "%.9g s", value);
  return text;
}

// The mean turn from the aligned estimate's bodies to the truth's; nothing where turns differ among poses,
// or where the positions do not determine the alignment.
double constant_turn(const std::vector<PosePair>& pairs) {
  std::vector<Vec3> from, to;
  for (const PosePair& pair : pairs) from.push_back(pair.estimate.translation), to.push_back(pair.truth.translation);
  const auto aligned = align_points(from, to, true);
  if (!aligned) return 0;
  std::vector<Quat> turns;
  Quat sum{0, 0, 0, 0};
  for (const PosePair& pair : pairs) {
    Quat q = (aligned->rotation * pair.estimate.rotation).conjugate() * pair.truth.rotation;
    if (!turns.empty() && q.w * turns[0].w + q.x * turns[0].x + q.y * turns[0].y + q.z * turns[0].z < 0)
      q = {-q.w, -q.x, -q.y, -q.z};
    turns.push_back(q);
    sum = {sum.w + q.w, sum.x + q.x, sum.y + q.y, sum.z + q.z};
  }
  const Quat mean = normalized(sum);
  double squares = 0;
  for (const Quat& q : turns) squares += quick::pow(turn_deg(mean.conjugate() * q), 2);
  const bool constant = std::sqrt(squares / double(turns.size())) < kLargestSpread;
  return constant ? turn_deg(mean) : 0;
}

}  // namespace

void check_comparable(const ComparedTracks& tracks, double max_difference) {
  const auto refuse = [](const std::string& file, const std::string& message, const std::string& expected,
                         const std::string& found, const std::string& hint) {
    throw InputError({file, 0, "", message, expected, found, hint});
  };
  const std::pair<const RecordedTrajectory&, const std::string&> both[] = {{tracks.estimate, tracks.estimate_path},
                                                                           {tracks.truth, tracks.truth_path}};
  for (const auto& [track, path] : both) {
    if (!track.has_rotations)
      refuse(path, "has no orientations", "columns qx, qy, qz, qw, or roll_deg, pitch_deg, yaw_deg", track.format, "");
    const bool no_time = track.has_stamps && track.poses.size() > 2 && span_seconds(track) <= max_difference;
    if (no_time)
      refuse(path, "has all stamps at nearly one time", "stamps further apart than " + seconds(max_difference),
             "a span of " + seconds(span_seconds(track)) + ", read as " + track.format,
             "name their unit in a first line, such as `t [s]`, or give --max-difference");
  }
  if (tracks.estimate.has_stamps != tracks.truth.has_stamps) {
    const bool of_estimate = !tracks.estimate.has_stamps;
    refuse(of_estimate ? tracks.estimate_path : tracks.truth_path, "has no stamps", "stamps, as the other file has",
           of_estimate ? tracks.estimate.format : tracks.truth.format, "write the stamp before each matrix");
  }
  if (!tracks.truth.has_stamps && tracks.estimate.poses.size() != tracks.truth.poses.size())
    refuse(tracks.estimate_path, "has another number of poses, and no stamps", std::to_string(tracks.truth.poses.size()),
           std::to_string(tracks.estimate.poses.size()), "write the stamp before each matrix");
}

std::string explain_no_overlap(const ComparedTracks& tracks) {
  const double a = tracks.estimate.poses.front().stamp, b = tracks.truth.poses.front().stamp;
  const double small = std::min(a, b), large = std::max(a, b);
  for (const auto& [factor, unit] : {std::pair{1e3, "milliseconds"}, {1e6, "microseconds"}, {1e9, "nanoseconds"}})
    if (small > 0 && large / small > 0.99 * factor && large / small < 1.01 * factor)
      return std::string("one file seems to be in ") + unit + ": name the unit in a first line, such as `t [ns]`";
  if (small < 1e7 && large > 1e8) return "one file counts from its start, the other since 1970: add the time of the start";
  return "--max-difference allows more";
}

std::vector<std::string> find_doubts(const ComparedTracks& tracks, const std::vector<PosePair>& pairs) {
  std::vector<std::string> doubts;
  const std::size_t fewer = std::min(tracks.estimate.poses.size(), tracks.truth.poses.size());
  if (double(pairs.size()) < kLeastShare * double(fewer))
    doubts.push_back("only " + std::to_string(pairs.size()) + " of " + std::to_string(fewer) +
                     " poses have a partner in time; the score says nothing about the others. " + tracks.estimate_path +
                     " covers " + seconds(tracks.estimate.poses.front().stamp) + " to " +
                     seconds(tracks.estimate.poses.back().stamp) + ", " + tracks.truth_path + " " +
                     seconds(tracks.truth.poses.front().stamp) + " to " + seconds(tracks.truth.poses.back().stamp));
  const double turn = pairs.size() < 3 ? 0 : constant_turn(pairs);
  if (turn > kLargestTurn)
    doubts.push_back("the orientations differ by the same turn of " + std::to_string(int(std::round(turn))) +
                     " degrees in every pose: one file may have optical frames (Z forward), the other bodies (X forward). "
                     "Absolute errors are right, relative ones are not");
  return doubts;
}

}  // namespace rubble
