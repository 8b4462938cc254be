// What the columns of a recorded trajectory mean, by their names. Private to trajectory_text.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace rubble {

enum class PoseQuantity { time, x, y, z, qw, qx, qy, qz, roll, pitch, yaw, other };
inline constexpr std::size_t kPoseQuantities = std::size_t(PoseQuantity::other);

struct PoseColumn {
  PoseQuantity quantity = PoseQuantity::other;
  std::string name;  // as the file has it
  // In seconds, metres or radians; 0: the name has no unit. Of times a power of ten.
  double unit = 0;
};

// Words between blanks, of which one like "[ns]" belongs to the word before it.
std::vector<std::string> join_units(const std::vector<std::string_view>& words);

PoseColumn classify_column(const std::string& name);

// Where each quantity stands in a row; -1: nowhere.
struct ColumnPlaces {
  std::vector<PoseColumn> columns;               // of a row, from the left
  std::array<int, kPoseQuantities> place{};      // by PoseQuantity
  bool has(PoseQuantity q) const { return place[std::size_t(q)] >= 0; }
  int of(PoseQuantity q) const { return place[std::size_t(q)]; }
  const PoseColumn& column(PoseQuantity q) const { return columns[std::size_t(of(q))]; }
  std::string left_out() const;  // names of the other columns, "vx, vy"
};

// Throws std::runtime_error: a quantity twice ("columns `a` and `b` are both x"). `names`: one each.
ColumnPlaces place_columns(const std::vector<std::string>& names);

// Whether x, y and z are among them: a comment with such words is a header.
bool names_positions(const std::vector<std::string>& names);

}  // namespace rubble
