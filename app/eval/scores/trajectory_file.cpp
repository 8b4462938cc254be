#include "app/eval/scores/trajectory_file.h"

#include <optional>

#include "io/base/atomic_file.h"
#include "kernel/base/error.h"
#include "kernel/base/tables/text_table.h"

namespace rubble {

RecordedTrajectory load_recorded_trajectory(const std::string& path, const std::string& columns) {
  return parse_trajectory(read_whole_file(path), path, columns);
}

void stamp_poses(const std::string& times, const std::string& path, RecordedTrajectory& track) {
  const auto fail = [&times](int line, const std::string& message, const std::string& expected, const std::string& found) {
    throw InputError({times, line, "", message, expected, found, ""});
  };
  const std::string text = read_whole_file(times);
  const TextTable table = read_text_table(text);
  if (table.rows.size() != track.poses.size())
    fail(0, "has another number of stamps than " + path + " has poses", std::to_string(track.poses.size()),
         std::to_string(table.rows.size()));
  for (std::size_t i = 0; i < track.poses.size(); ++i) {
    const TextRow& row = table.rows[i];
    StampedPose& pose = track.poses[i];
    const auto ns = row.words.size() == 1 ? parse_scaled_integer(row.words[0], 9) : std::nullopt;
    const auto stamp = ns ? parse_number(row.words[0]) : std::nullopt;
    if (!stamp) fail(row.line, "not a stamp", "one number, in s", std::string(row.words.empty() ? "" : row.words[0]));
    if (i > 0 && *stamp < track.poses[i - 1].stamp) fail(row.line, "out of order", "stamps that do not decrease", std::string(row.words[0]));
    pose.stamp = *stamp, pose.stamp_ns = *ns;
  }
  track.has_stamps = true;
}

std::vector<StampedPose> load_trajectory(const std::string& path) { return load_recorded_trajectory(path).poses; }

}  // namespace rubble
