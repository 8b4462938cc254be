#include "app/eval/scores/trajectory_file.h"

#include <charconv>
#include <cmath>
#include <sstream>

#include "io/base/atomic_file.h"
#include "kernel/base/error.h"

namespace rubble {
namespace {

constexpr std::size_t kNumbers = 8;  // of a pose with its stamp

[[noreturn]] void refuse(const std::string& path, int line, const std::string& message,
                         const std::string& expected, const std::string& found,
                         const std::string& hint = "") {
  throw InputError({path, line, "", message, expected, found, hint});
}

std::vector<std::string> split(std::string text, bool commas) {
  if (commas) {
    for (char& c : text)
      if (c == ',') c = ' ';
  }
  std::istringstream words(text);
  std::vector<std::string> result;
  for (std::string word; words >> word;) result.push_back(word);
  return result;
}

double read_number(const std::string& word, const std::string& path, int line) {
  double value = 0;
  const char* first = word.data() + (word[0] == '+' ? 1 : 0);
  const char* last = word.data() + word.size();
  const auto [end, failed] = std::from_chars(first, last, value);
  if (failed != std::errc() || end != last) refuse(path, line, "not a number", "a number", word);
  if (!std::isfinite(value)) refuse(path, line, "not finite", "a finite number", word);
  return value;
}

Quat read_rotation(const Quat& q, const std::string& path, int line) {
  const double length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  if (std::abs(length - 1) > 0.01)
    refuse(path, line, "not a rotation", "a quaternion of length 1", std::to_string(length));
  return normalized(q);
}

StampedPose read_pose(const std::string& text, bool euroc, const std::string& path, int line) {
  const std::vector<std::string> words = split(text, euroc);
  if (words.size() < kNumbers || (!euroc && words.size() > kNumbers))
    refuse(path, line, "not a pose",
           euroc ? "stamp,px,py,pz,qw,qx,qy,qz (EuRoC)" : "stamp tx ty tz qx qy qz qw (TUM)",
           std::to_string(words.size()) + " values");
  double n[kNumbers];
  for (std::size_t i = 0; i < kNumbers; ++i) n[i] = read_number(words[i], path, line);
  StampedPose pose;
  pose.line = line;
  pose.stamp = euroc ? n[0] * 1e-9 : n[0];
  pose.world_from_body.translation = {n[1], n[2], n[3]};
  const Quat q = euroc ? Quat{n[4], n[5], n[6], n[7]} : Quat{n[7], n[4], n[5], n[6]};
  pose.world_from_body.rotation = read_rotation(q, path, line);
  return pose;
}

void check_order(const StampedPose& before, const StampedPose& pose, const std::string& path) {
  if (pose.stamp > before.stamp) return;
  refuse(path, pose.line, pose.stamp == before.stamp ? "the stamp repeats" : "out of order",
         "a stamp after that of line " + std::to_string(before.line), std::to_string(pose.stamp),
         "sort the file by its first column and leave out what repeats");
}

}  // namespace

std::vector<StampedPose> load_trajectory(const std::string& path) {
  std::istringstream text(read_whole_file(path));
  std::vector<StampedPose> poses;
  int number = 0;
  for (std::string line; std::getline(text, line);) {
    ++number;
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first == std::string::npos || line[first] == '#') continue;
    const bool euroc = line.find(',') != std::string::npos;
    poses.push_back(read_pose(line, euroc, path, number));
    if (poses.size() > 1) check_order(poses[poses.size() - 2], poses.back(), path);
  }
  if (poses.empty()) refuse(path, 0, "holds no pose", "lines of a TUM or EuRoC trajectory", "none");
  return poses;
}

}  // namespace rubble
