// What the columns of a recorded trajectory mean, by their names. Private to trajectory_text.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace rubble {

enum class PoseQuantity { time, x, y, z, qw, qx, qy, qz, roll, pitch, yaw, fraction, other };  // fraction: of a second, beside whole ones
inline constexpr std::size_t kPoseQuantities = std::size_t(PoseQuantity::other);

struct PoseColumn {
  PoseQuantity quantity = PoseQuantity::other;
  std::string name;  // as the file has it
  double unit = 0;                  // in seconds, metres or radians; 0: the name has no unit
  std::string unknown_unit;         // in brackets, of a quantity that has units
  std::vector<std::string> stem;    // words without a unit: header, stamp
};

PoseColumn classify_column(const std::string& name);

// For messages: "m, cm, ..."; nullptr: the quantity has no unit.
const char* units_of(PoseQuantity quantity);

// Where each quantity stands in a row; -1: nowhere.
struct ColumnPlaces {
  std::vector<PoseColumn> columns;               // of a row, from the left
  std::array<int, kPoseQuantities> place{};      // by PoseQuantity
  bool half_stamp = false;  // the time is one half of a ROS stamp, "header.stamp.secs" without its nanoseconds
  bool has(PoseQuantity q) const { return place[std::size_t(q)] >= 0; }
  int of(PoseQuantity q) const { return place[std::size_t(q)]; }
  const PoseColumn& column(PoseQuantity q) const { return columns[std::size_t(of(q))]; }
  void choose_stamp();  // of several columns with times. A stamp in two columns: `time` has the seconds
  std::string left_out() const;  // names of the other columns, "vx, vy"
};

// Throws std::runtime_error: a quantity twice ("columns `a` and `b` are both x"). `names`: one each.
ColumnPlaces place_columns(const std::vector<std::string>& names);

// Whether x, y and z are among them: a comment with such words is a header.
bool names_positions(const std::vector<std::string>& names);

}  // namespace rubble
