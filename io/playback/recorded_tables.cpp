#include "io/playback/recorded_tables.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "io/base/little_endian.h"
#include "kernel/base/error.h"
#include "kernel/base/portable_math.h"
#include "kernel/base/read_file.h"

namespace rubble {
namespace {

bool parse_double(const std::string& word, double& value) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

// "12.000000345" or "12" as nanoseconds: a double cannot hold them.
bool parse_seconds(const std::string& word, std::int64_t& stamp_ns) {
  const std::size_t point = word.find('.');
  std::string digits = point == std::string::npos ? "" : word.substr(point + 1);
  if (digits.size() > 9) return false;
  digits.resize(9, '0');
  digits.insert(0, word.substr(0, point));
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), stamp_ns);
  return error == std::errc() && end == digits.data() + digits.size();
}

[[noreturn]] void fail(const NumberTable& table, std::size_t row, const std::string& expected, const std::string& found) {
  throw InputError({table.path, int(table.lines[row]), "", "the line is damaged", expected, found, ""});
}

std::int64_t whole(const NumberTable& table, std::size_t row, std::size_t column) {
  const std::string& word = table.words[row][column];
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) fail(table, row, "a whole number", word);
  return value;
}

std::int64_t seconds(const NumberTable& table, std::size_t row, std::size_t column) {
  std::int64_t stamp_ns = 0;
  if (!parse_seconds(table.words[row][column], stamp_ns)) fail(table, row, "seconds with nine decimals", table.words[row][column]);
  return stamp_ns;
}

Vec3 vector_in(const std::vector<double>& row, std::size_t from) { return {row[from], row[from + 1], row[from + 2]}; }

}  // namespace

NumberTable read_number_table(const std::string& path, char separator, std::size_t columns, int text_column) {
  NumberTable table{path, {}, {}, {}};
  std::istringstream in(read_file(path));
  std::size_t number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (line.empty() || line[0] == '#' || (number == 1 && std::isalpha(static_cast<unsigned char>(line[0])))) continue;
    std::vector<std::string> words;
    std::istringstream parts(line);
    for (std::string word; std::getline(parts, word, separator);) words.push_back(word);
    table.lines.push_back(number);
    table.words.push_back(words);
    if (words.size() != columns)
      fail(table, table.lines.size() - 1, std::to_string(columns) + " words", std::to_string(words.size()));
    std::vector<double>& row = table.rows.emplace_back();
    for (std::size_t i = 0; i < columns; ++i) {
      row.push_back(0);
      if (int(i) != text_column && !parse_double(words[i], row.back())) fail(table, table.lines.size() - 1, "a number", words[i]);
    }
  }
  return table;
}

std::vector<Frame> read_frame_poses(const std::string& path) {
  const NumberTable table = read_number_table(path, ',', 12);
  std::vector<Frame> frames;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const std::vector<double>& row = table.rows[i];
    Frame& frame = frames.emplace_back();
    frame.index = int(whole(table, i, 0));
    if (frame.index != int(i)) fail(table, i, "frame " + std::to_string(i), "frame " + table.words[i][0]);
    frame.stamp_ns = whole(table, i, 1);
    frame.world_from_camera = {{row[5], row[6], row[7], row[8]}, vector_in(row, 2)};
    frame.linear_velocity = vector_in(row, 9);
  }
  return frames;
}

std::vector<ImuSample> read_imu_table(const std::string& path, int sensor) {
  const NumberTable table = read_number_table(path, ',', 13);
  std::vector<ImuSample> samples;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const std::vector<double>& row = table.rows[i];
    samples.push_back({whole(table, i, 0), sensor, vector_in(row, 1), vector_in(row, 4), vector_in(row, 7), vector_in(row, 10)});
  }
  return samples;
}

std::vector<Event> read_event_table(const std::string& path) {
  const NumberTable table = read_number_table(path, ' ', 4);
  std::vector<Event> events;
  for (std::size_t i = 0; i < table.rows.size(); ++i)
    events.push_back({seconds(table, i, 0), std::uint16_t(table.rows[i][1]), std::uint16_t(table.rows[i][2]), table.rows[i][3] > 0});
  return events;
}

std::map<std::int64_t, Pose> read_tum_poses(const std::string& path) {
  const NumberTable table = read_number_table(path, ' ', 8);
  std::map<std::int64_t, Pose> poses;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const std::vector<double>& row = table.rows[i];
    poses[seconds(table, i, 0)] = {{row[7], row[4], row[5], row[6]}, vector_in(row, 1)};
  }
  return poses;
}

std::vector<Reading> read_reading_table(const std::string& path, std::size_t columns, int sensor) {
  const NumberTable table = read_number_table(path, ',', columns + 1);
  std::vector<Reading> readings;
  for (std::size_t i = 0; i < table.rows.size(); ++i)
    readings.push_back({sensor, whole(table, i, 0), {table.rows[i].begin() + 1, table.rows[i].end()}});
  return readings;
}

RecordedScans::RecordedScans(const std::string& folder, const SensorRecord& sensor) : folder_(folder + "/" + sensor.name), spec_(sensor.format->scan_spec()) {
  const NumberTable stamps = read_number_table(folder_ + "/stamps.txt", ' ', 2, 1);
  for (std::size_t i = 0; i < stamps.rows.size(); ++i) {
    stamps_ns_.push_back(seconds(stamps, i, 0));
    files_.push_back(stamps.words[i][1]);
  }
  const NumberTable motion = read_number_table(folder_ + "/motion.txt", ' ', 8);
  for (std::size_t i = 0; i < motion.rows.size(); ++i) {
    const std::vector<double>& row = motion.rows[i];
    motion_ns_.push_back(seconds(motion, i, 0));
    if (i > 0 && motion_ns_[i] <= motion_ns_[i - 1]) fail(motion, i, "a stamp later than the one before", motion.words[i][0]);
    motion_.push_back({{row[7], row[4], row[5], row[6]}, vector_in(row, 1)});
  }
  if (motion_.empty()) throw InputError({motion.path, 0, "", "has no poses", "at least one", "", ""});
}

Pose RecordedScans::pose_at(std::int64_t stamp_ns) const {
  const auto after = std::size_t(std::lower_bound(motion_ns_.begin(), motion_ns_.end(), stamp_ns) - motion_ns_.begin());
  if (after == motion_.size()) return motion_.back();
  if (after == 0 || motion_ns_[after] == stamp_ns) return motion_[after];
  const double share = double(stamp_ns - motion_ns_[after - 1]) / double(motion_ns_[after] - motion_ns_[after - 1]);
  const Pose &a = motion_[after - 1], &b = motion_[after];
  return {portable::slerp(a.rotation, b.rotation, share), a.translation + (b.translation - a.translation) * share};
}

std::shared_ptr<const RangeScan> RecordedScans::read(std::size_t index) const {
  const std::string path = folder_ + "/" + files_[index], bytes = read_file(path);
  constexpr std::string_view kFields = "FIELDS x y z intensity ring time\nSIZE 4 4 4 4 2 4\nTYPE F F F F U F\n", kData = "\nDATA binary\n";
  const std::size_t data = bytes.find(kData);
  if (bytes.find(kFields) == std::string::npos || data == std::string::npos)
    throw InputError({path, 0, "", "is no scan that Rubble wrote", "a binary PCD file with " + std::string(kFields.substr(0, 32)), "", ""});
  std::string_view left = std::string_view(bytes).substr(data + kData.size());
  constexpr std::size_t kPoint = 22;  // unit: byte
  const std::string count = std::to_string(left.size() / kPoint);
  if (left.size() % kPoint != 0 || bytes.find("\nPOINTS " + count + "\n") == std::string::npos)
    throw InputError({path, 0, "", "the scan is damaged", "as many points as its header states", std::to_string(left.size()) + " bytes of points", ""});
  RangeScan scan;
  scan.spec = spec_;
  scan.stamp_ns = stamps_ns_[index];
  scan.index = int(index);
  while (!left.empty()) {
    ScanPoint p;
    for (float* value : {&p.x, &p.y, &p.z, &p.intensity}) take(left, *value);
    take(left, p.ring), take(left, p.time);
    const std::int64_t delay = p.ring < spec_->delays_ns.size() ? spec_->delays_ns[p.ring] : 0;
    p.column = std::uint16_t(std::llround((double(p.time) * 1e9 - double(delay)) / double(spec_->column_ns)));
    scan.points.push_back(p);
  }
  const std::int64_t delay = spec_->delays_ns.empty() ? 0 : *std::max_element(spec_->delays_ns.begin(), spec_->delays_ns.end());
  const std::int64_t steps = ((spec_->columns - 1) * spec_->column_ns + delay) / RangeScan::kMotionStep + 1;
  for (std::int64_t i = 0; i <= steps; ++i) scan.world_from_sensor.push_back(pose_at(scan.stamp_ns + i * RangeScan::kMotionStep));
  return std::make_shared<const RangeScan>(std::move(scan));
}

}  // namespace rubble
