#include "scripting/trajectory/trajectory_text.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "kernel/base/error.h"
#include "kernel/base/number_text.h"
#include "kernel/base/portable_math.h"
#include "kernel/base/tables/text_table.h"
#include "scripting/values/column_names.h"
#include "scripting/trajectory/trajectory_columns.h"

namespace rubble {
namespace {

using Q = PoseQuantity;

constexpr const char* kLayouts =
    "a first line that names the columns (t,x,y,z,qx,qy,qz,qw), 8 numbers between blanks (TUM), 12 (KITTI), or "
    "integer nanoseconds and 7 or more numbers between commas or semicolons (EuRoC)";
constexpr const char* kNameThem = "name the columns in a first line, such as t,x,y,z,qx,qy,qz,qw, or by `columns`";

// unit: of the stamp, s
constexpr double kLatestSeconds = 1e11, kLatestMillis = 1e14, kLatestMicros = 1e17;
constexpr double kStepOfNanoseconds = 1e5;  // least median step of integers that are taken for ns
constexpr double kLongestStep = 1e4;        // largest median step that stamps without a unit may have; unit: s
constexpr double kOddStep = 10;             // above it, the user is told the unit that was taken; unit: s
constexpr double kLengthTolerance = 0.01;   // of a quaternion or of a matrix's rows

struct StampUnit {
  int digits = 9;  // of 10^digits ns
  const char* name = "s";
  int count = 1;   // of these
};
constexpr StampUnit kSeconds{9, "s"}, kMillis{6, "ms"}, kMicros{3, "us"}, kNanos{0, "ns"}, kMinutes{9, "min", 60}, kHours{9, "h", 3600};

StampUnit stamp_unit(double seconds) {
  if (seconds > 1000) return kHours;
  if (seconds > 10) return kMinutes;
  if (seconds > 0.5) return kSeconds;
  if (seconds > 0.5e-3) return kMillis;
  return seconds > 0.5e-6 ? kMicros : kNanos;
}

Quat quat_from_rows(const Vec3 rows[3]) {
  const double trace = rows[0].x + rows[1].y + rows[2].z;
  if (trace > 0) {
    const double s = std::sqrt(trace + 1) * 2;
    return normalized(Quat{s / 4, (rows[2].y - rows[1].z) / s, (rows[0].z - rows[2].x) / s, (rows[1].x - rows[0].y) / s});
  }
  const int i = rows[0].x >= rows[1].y && rows[0].x >= rows[2].z ? 0 : rows[1].y >= rows[2].z ? 1 : 2;
  const int j = (i + 1) % 3, k = (i + 2) % 3;
  const double s = std::sqrt(1 + rows[i][i] - rows[j][j] - rows[k][k]) * 2;
  Vec3 v;
  v[i] = s / 4, v[j] = (rows[j][i] + rows[i][j]) / s, v[k] = (rows[k][i] + rows[i][k]) / s;
  return normalized(Quat{(rows[k][j] - rows[j][k]) / s, v.x, v.y, v.z});
}

class TrajectoryReader {
 public:
  TrajectoryReader(std::string_view text, const std::string& path)
      : path_(path), utf16_(is_utf16(text)), table_(read_text_table(text)) {}

  RecordedTrajectory read(const std::string& columns) {
    if (utf16_) refuse(0, "is UTF-16 text", "UTF-8", "the byte order mark of UTF-16", "save it as UTF-8");
    find_header(columns);
    if (rows().empty()) refuse(0, "has no pose", kLayouts, "no line of numbers");
    width_ = width_of(rows().front());
    choose_layout();
    choose_stamp_unit();
    if (check_euroc_) check_euroc();
    for (const TextRow& row : rows()) add_pose(row);
    finish_notes();
    return std::move(result_);
  }

 private:
  [[noreturn]] void refuse(int line, const std::string& message, const std::string& expected = "",
                           const std::string& found = "", const std::string& hint = "") const {
    throw InputError({path_, line, "", message, expected, found, hint});
  }

  const std::vector<TextRow>& rows() const { return table_.rows; }

  // A last word that is empty comes from a separator at the line's end.
  static std::size_t width_of(const TextRow& row) {
    return row.words.size() - (row.words.size() > 1 && row.words.back().empty() ? 1 : 0);
  }

  static bool has_number(const TextRow& row) {
    return std::any_of(row.words.begin(), row.words.end(), [](std::string_view w) { return bool(parse_number(w)); });
  }

  void find_header(const std::string& columns) {
    const bool words = !rows().empty() && !has_number(rows().front());
    if (!columns.empty()) {
      names_ = join_units(split_words(columns, 0).words);
      header_ = "`columns`";
    } else if (words) {
      names_ = join_units(rows().front().words);
      header_ = "line " + std::to_string(rows().front().line);
    }
    if (words) table_.rows.erase(table_.rows.begin());
    if (names_.empty() && !rows().empty()) find_comment_header();
    if (!names_.empty() && names_.back().empty()) names_.pop_back();
  }

  // The last comment before the first row that has a name for each of its columns.
  void find_comment_header() {
    const TextRow& first = rows().front();
    for (const TextRow& comment : table_.comments) {
      if (comment.line > first.line) break;
      std::vector<std::string> names = join_units(comment.words);
      while (names.size() > 1 && names.back().empty()) names.pop_back();
      if (!names_positions(names)) continue;
      if (names.size() == width_of(first)) {
        names_ = std::move(names);
        header_ = "line " + std::to_string(comment.line);
      } else if (first.separator != ' ' && comment.separator == first.separator) {
        refuse(comment.line, "is a header of other columns", std::to_string(width_of(first)) + " names, as the rows have values",
               std::to_string(names.size()) + " names");
      }
    }
  }

  void choose_layout() {
    const char separator = rows().front().separator;
    if (!names_.empty()) return use_names();
    if (width_ == 12 || width_ == 16) return use_matrices(false);
    if (separator == ' ' && (width_ == 13 || width_ == 17)) return use_matrices(true);
    if (separator == ' ' && width_ == 8) {
      place({"stamp", "tx", "ty", "tz", "qx", "qy", "qz", "qw"});
      result_.optical = true;
      result_.format = "TUM (stamp tx ty tz qx qy qz qw";
      return;
    }
    if (separator != ' ' && width_ >= 8) {
      std::vector<std::string> names{"stamp", "px", "py", "pz", "qw", "qx", "qy", "qz"};
      names.resize(width_);
      place(names);
      check_euroc_ = true;
      result_.format = "EuRoC (stamp,px,py,pz,qw,qx,qy,qz";
      return;
    }
    refuse(rows().front().line, "not a pose", kLayouts, std::to_string(width_) + " values between " + separators(), kNameThem);
  }

  const char* separators() const {
    const char separator = rows().front().separator;
    return separator == ',' ? "commas" : separator == ';' ? "semicolons" : "blanks";
  }

  void place(const std::vector<std::string>& names) {
    try {
      places_ = place_columns(names);
    } catch (const std::runtime_error& twice) {
      refuse(0, twice.what(), "one column for each quantity", header_, kNameThem);
    }
    for (const PoseColumn& column : places_.columns)
      if (!column.unknown_unit.empty() && column.quantity != Q::other)
        refuse(0, "column `" + column.name + "` has an unknown unit", units_of(column.quantity),
               "`" + column.unknown_unit + "` in " + header_, "convert it, or give `columns`");
  }

  void use_names() {
    place(names_);
    std::string found;
    for (const std::string& name : names_) found += (found.empty() ? "" : ", ") + name;
    if (names_.size() != width_)
      refuse(rows().front().line, "not a pose", std::to_string(names_.size()) + " values, as " + header_ + " names",
             std::to_string(width_) + " values");
    for (const auto& [quantity, word] : {std::pair{Q::time, "t"}, {Q::x, "x"}, {Q::y, "y"}, {Q::z, "z"}})
      if (!places_.has(quantity))
        refuse(0, std::string("has no column ") + word,
               std::string(word) + (quantity == Q::time ? ", time, timestamp or stamp, such as `t` or `timestamp [ns]`" : ""),
               "the columns " + found + " (" + header_ + ")", kNameThem);
    int parts = 0, angles = 0;
    for (const Q q : {Q::qw, Q::qx, Q::qy, Q::qz}) parts += places_.has(q);
    for (const Q q : {Q::roll, Q::pitch, Q::yaw}) angles += places_.has(q);
    if (parts > 0 && parts < 4)
      refuse(0, "has a part of a quaternion only", "qx, qy, qz and qw", "the columns " + found + " (" + header_ + ")");
    quaternions_ = parts == 4;
    result_.has_rotations = parts + angles > 0;
    if (!result_.has_rotations) result_.notes.push_back("no column is an orientation (qx, qy, qz, qw, or yaw_deg)");
    if (!quaternions_ && angles > 0) choose_angle_units();
    if (quaternions_ && angles > 0) result_.notes.push_back("the quaternion is taken, roll, pitch and yaw are left out");
    const std::string rest = places_.left_out();
    if (!rest.empty()) result_.notes.push_back("left out: " + (rest.size() > 100 ? rest.substr(0, 97) + "..." : rest));
    name_columns();
  }

  // TUM's own order between blanks is TUM's format, whether a comment names it or not.
  void name_columns() {
    const Q order[] = {Q::time, Q::x, Q::y, Q::z, Q::qx, Q::qy, Q::qz, Q::qw};
    bool tum = rows().front().separator == ' ' && places_.columns.size() == 8;
    for (std::size_t i = 0; tum && i < 8; ++i) tum = places_.columns[i].quantity == order[i];
    result_.optical = tum;
    result_.format = tum ? "TUM (stamp tx ty tz qx qy qz qw" : "the columns that " + header_ + " names (";
    if (tum) return;
    std::string list;
    for (const PoseColumn& column : places_.columns)
      if (column.quantity != Q::other) list += (list.empty() ? "" : ",") + column.name;
    result_.format += list;
  }

  // Angles that no name gives a unit are degrees if one is more than a turn in radians.
  void choose_angle_units() {
    for (const Q q : {Q::roll, Q::pitch, Q::yaw}) {
      if (!places_.has(q) || places_.column(q).unit > 0) continue;
      double most = 0;
      for (const TextRow& row : rows())
        if (std::size_t(places_.of(q)) < row.words.size())
          most = std::max(most, std::abs(parse_number(row.words[std::size_t(places_.of(q))]).value_or(0)));
      const std::string name = places_.column(q).name;
      if (most <= 2 * portable::kPi + 0.01)
        refuse(0, "column `" + name + "` may be degrees or radians", name + "_deg or " + name + "_rad", "no unit in " + header_,
               "rename it, or give `columns`");
      places_.columns[std::size_t(places_.of(q))].unit = portable::kPi / 180;
      result_.notes.push_back("column `" + name + "` is taken as degrees");
    }
  }

  void use_matrices(bool stamps) {
    matrix_at_ = stamps ? 1 : 0;
    result_.has_stamps = stamps;
    result_.optical = result_.optical_world = true;
    std::vector<std::string> names(width_);
    if (stamps) names[0] = "stamp";
    place(names);
    const bool whole = width_ >= 16;
    result_.format = std::string(stamps ? "a stamp and a" : "KITTI (a") + (whole ? " 4 x 4" : " 3 x 4") +
                     (stamps ? " matrix (optical frames" : " matrix in each line, no stamps");
    matrix_ = true;
  }

  double number_at(const TextRow& row, std::size_t place) const {
    const std::string_view word = row.words[place];
    const auto value = parse_number(word);
    if (!value) {
      const bool named = !names_.empty();
      const bool comma = word.find(',') != std::string_view::npos;
      refuse(row.line, named ? "no number in the column " + names_[place] : "not a number", "a number",
             "`" + std::string(word) + "`", comma ? "write numbers with a decimal point" : "");
    }
    if (!std::isfinite(*value))
      refuse(row.line, "not finite", "a finite number", std::string(word), "leave lines without a pose out");
    return *value;
  }

  void check_width(const TextRow& row) const {
    if (width_of(row) == width_) return;
    const std::string names = names_.empty() ? "" : ", which " + header_ + " names";
    refuse(row.line, "not a pose", std::to_string(width_) + " values as in line " + std::to_string(rows().front().line) + names,
           std::to_string(width_of(row)) + " values" +
               (row.separator != rows().front().separator ? ", with another separator" : ""));
  }

  std::size_t time_place() const { return std::size_t(places_.of(Q::time)); }

  double median_step() const {
    std::vector<double> steps;
    for (std::size_t i = 1; i < rows().size(); ++i) {
      const double step = number_at(rows()[i], time_place()) - number_at(rows()[i - 1], time_place());
      if (step > 0) steps.push_back(step);
    }
    if (steps.empty()) return 0;
    std::nth_element(steps.begin(), steps.begin() + std::ptrdiff_t(steps.size() / 2), steps.end());
    return steps[steps.size() / 2];
  }

  void choose_stamp_unit() {
    for (const TextRow& row : rows()) check_width(row);
    if (!result_.has_stamps) return;
    const PoseColumn& column = places_.column(Q::time);
    if (places_.half_stamp) check_half_stamp();
    if (places_.has(Q::fraction)) {
      check_two_columns();
    } else if (column.unit > 0) {
      unit_ = stamp_unit(column.unit);
    } else {
      unit_ = guess_stamp_unit();
    }
    result_.format += std::string("; stamps in ") + unit_.name;
  }

  // Whole seconds alone, or nanoseconds below one second: the other column of a ROS stamp is missing.
  void check_half_stamp() const {
    const PoseColumn& column = places_.column(Q::time);
    for (const TextRow& row : rows()) {
      const double value = number_at(row, time_place());
      if (value != std::floor(value) || (column.unit < 1 && value >= 1e9)) return;
    }
    refuse(0, "column `" + column.name + "` is half of a stamp",
           column.unit < 1 ? "the seconds as well, such as `header.stamp.secs`"
                           : "the nanoseconds as well, such as `header.stamp.nsecs`",
           "no such column in " + header_, "or name it `t [s]` by `columns` if it is the whole stamp");
  }

  // Whole seconds and the rest, in two columns.
  void check_two_columns() {
    const PoseColumn& rest = places_.column(Q::fraction);
    const double most = std::round(1 / rest.unit);
    for (const TextRow& row : rows()) {
      const double whole = number_at(row, time_place()), part = number_at(row, std::size_t(places_.of(Q::fraction)));
      if (whole == std::floor(whole) && part == std::floor(part) && part >= 0 && part < most) continue;
      refuse(row.line, "columns `" + places_.column(Q::time).name + "` and `" + rest.name + "` are no stamp",
             "whole seconds, and an integer from 0 to " + plain_text(most - 1), plain_text(whole) + " and " + plain_text(part),
             "name one of both only, by `columns`");
    }
  }

  StampUnit guess_stamp_unit() {
    double largest = 0;
    bool integers = true;
    for (const TextRow& row : rows()) {
      largest = std::max(largest, std::abs(number_at(row, time_place())));
      integers = integers && row.words[time_place()].find_first_not_of("+-0123456789") == std::string_view::npos;
    }
    if (largest >= kLatestMicros) return kNanos;
    if (largest >= kLatestMillis) return kMicros;
    if (largest >= kLatestSeconds) return kMillis;
    const double step = median_step();
    if (integers && step >= kStepOfNanoseconds) {
      result_.notes.push_back("the stamps are taken as nanoseconds, by their steps");
      return kNanos;
    }
    if (step > kLongestStep)
      refuse(0, "the unit of the stamps is not clear", "a column such as `t [ns]`, or steps of less than 10000 s",
             "steps of " + brief_text(step), kNameThem);
    if (step > kOddStep)
      result_.notes.push_back("the stamps are taken as seconds, " + brief_text(step) +
                              " s apart; if they are not, name the column `t [ms]` or so");
    return kSeconds;
  }

  // Between commas or semicolons only EuRoC's own order is known without names, and its stamps are nanoseconds.
  void check_euroc() const {
    if (unit_.digits == kNanos.digits) return;
    refuse(rows().front().line, "the order of the columns is not known", kLayouts,
           std::to_string(width_) + " numbers between " + separators() + " with stamps in " + unit_.name, kNameThem);
  }

  double scaled(const TextRow& row, Q quantity) const {
    const double unit = places_.column(quantity).unit;
    const double value = number_at(row, std::size_t(places_.of(quantity)));
    return unit > 0 ? value * unit : value;
  }

  // In degrees, without a rounding where the file has degrees.
  double angle_deg(const TextRow& row, Q quantity) const {
    if (!places_.has(quantity)) return 0;
    const double value = number_at(row, std::size_t(places_.of(quantity)));
    if (std::abs(value) > 1e6) refuse(row.line, "not a rotation", "an angle of at most 1e6", plain_text(value));
    return places_.column(quantity).unit == 1 ? value * (180 / portable::kPi) : value;
  }

  Quat rotation_of(const TextRow& row) {
    if (!quaternions_) {
      const Vec3 deg{angle_deg(row, Q::roll), angle_deg(row, Q::pitch), angle_deg(row, Q::yaw)};
      result_.rpy_deg.push_back(deg);
      const Vec3 rad = deg * (portable::kPi / 180);
      return portable::quat_from_rpy(rad.x, rad.y, rad.z);
    }
    const Quat q{scaled(row, Q::qw), scaled(row, Q::qx), scaled(row, Q::qy), scaled(row, Q::qz)};
    const double length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    if (!(std::abs(length - 1) <= kLengthTolerance))
      refuse(row.line, "not a rotation", "a quaternion of length 1", brief_text(length));
    return normalized(q);
  }

  Pose matrix_of(const TextRow& row) const {
    Vec3 lines[3];
    Pose pose;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 4; ++k)
        (k < 3 ? lines[i][int(k)] : pose.translation[int(i)]) = number_at(row, matrix_at_ + 4 * i + k);
    bool fine = dot(cross(lines[0], lines[1]), lines[2]) > 0;
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k)
        fine = fine && std::abs(dot(lines[i], lines[k]) - (i == k ? 1 : 0)) <= 2 * kLengthTolerance;
    if (width_ >= 16)
      for (std::size_t k = 0; k < 4; ++k) fine = fine && number_at(row, matrix_at_ + 12 + k) == (k < 3 ? 0 : 1);
    if (!fine)
      refuse(row.line, "not a rotation",
             width_ >= 16 ? "the rows of a rigid transform, 4 x 4" : "the first three rows of a rigid transform",
             std::to_string(width_) + " other numbers", kNameThem);
    pose.rotation = quat_from_rows(lines);
    return pose;
  }

  void add_pose(const TextRow& row) {
    StampedPose pose;
    pose.line = row.line;
    if (matrix_) {
      pose.world_from_body = matrix_of(row);
    } else {
      pose.world_from_body.translation = {scaled(row, Q::x), scaled(row, Q::y), scaled(row, Q::z)};
      if (result_.has_rotations) pose.world_from_body.rotation = rotation_of(row);
    }
    stamp(pose, row);
    check_order(pose);
    result_.poses.push_back(pose);
  }

  void stamp(StampedPose& pose, const TextRow& row) const {
    if (!result_.has_stamps) {
      pose.stamp = double(result_.poses.size());
      pose.stamp_ns = std::int64_t(result_.poses.size()) * 1000000000;
      return;
    }
    double scale = 1;
    for (int i = unit_.digits; i < 9; ++i) scale *= 10;
    pose.stamp = number_at(row, time_place()) / scale * unit_.count;
    const auto exact = parse_scaled_integer(row.words[time_place()], unit_.digits);
    const double most = double(std::numeric_limits<std::int64_t>::max()) * 1e-9;
    if (!exact || !(std::abs(pose.stamp) < most - 1)) refuse(row.line, "out of range", "a stamp", std::string(row.words[time_place()]));
    pose.stamp_ns = unit_.count == 1 ? *exact : std::llround(pose.stamp * 1e9);
    if (!places_.has(Q::fraction)) return;
    const PoseColumn& rest = places_.column(Q::fraction);
    const double part = number_at(row, std::size_t(places_.of(Q::fraction)));
    pose.stamp += part * rest.unit;
    pose.stamp_ns += std::int64_t(part) * std::llround(rest.unit * 1e9);
  }

  void check_order(const StampedPose& pose) {
    if (result_.poses.empty() || !result_.has_stamps) return;
    const StampedPose& before = result_.poses.back();
    if (pose.stamp_ns == before.stamp_ns) result_.repeated.push_back(pose.line);
    if (pose.stamp_ns >= before.stamp_ns) return;
    refuse(pose.line, "out of order", "a stamp after that of line " + std::to_string(before.line), plain_text(pose.stamp),
           "sort the file by its stamps");
  }

  void finish_notes() {
    result_.format += ")";
    const std::size_t count = result_.repeated.size();
    if (count == 0) return;
    result_.notes.push_back("line " + std::to_string(result_.repeated.front()) + " repeats the stamp of the line before" +
                            (count > 1 ? ", as do " + std::to_string(count - 1) + " more" : ""));
  }

  std::string path_;
  bool utf16_;
  TextTable table_;
  std::vector<std::string> names_;  // of the columns; empty: none are named
  std::string header_;              // where they stand, "line 1"
  std::size_t width_ = 0;           // values in a row
  ColumnPlaces places_;
  StampUnit unit_;
  bool check_euroc_ = false, matrix_ = false, quaternions_ = true;
  std::size_t matrix_at_ = 0;  // its first number in a row
  RecordedTrajectory result_;
};

}  // namespace

RecordedTrajectory parse_trajectory(std::string_view text, const std::string& path, const std::string& columns) {
  return TrajectoryReader(text, path).read(columns);
}

Pose body_pose(const Pose& world_from_body, bool optical, bool optical_world) {
  Pose pose = world_from_body;
  if (optical) pose = pose * camera_from_optical.inverse();
  if (optical_world) pose = camera_from_optical * pose;
  return pose;
}

}  // namespace rubble
