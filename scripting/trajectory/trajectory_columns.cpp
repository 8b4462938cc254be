#include "scripting/trajectory/trajectory_columns.h"

#include <algorithm>
#include <stdexcept>

#include "scripting/values/column_names.h"

namespace rubble {
namespace {

using Tokens = std::vector<std::string>;

bool any_among(const Tokens& tokens, std::initializer_list<const char*> words) {
  return std::any_of(tokens.begin(), tokens.end(), [&](const std::string& t) { return is_one_of(t, words); });
}

PoseQuantity axis_of(const std::string& word, std::initializer_list<const char*> prefixes, PoseQuantity first) {
  for (const char* prefix : prefixes)
    for (int i = 0; i < 3; ++i)
      if (word == std::string(prefix) + "xyz"[i]) return PoseQuantity(int(first) + i);
  return PoseQuantity::other;
}

PoseQuantity angle_of(const std::string& word) {
  if (word == "roll") return PoseQuantity::roll;
  if (word == "pitch") return PoseQuantity::pitch;
  return word == "yaw" ? PoseQuantity::yaw : PoseQuantity::other;
}

// Of a name that is one word.
PoseQuantity quantity_of_word(const std::string& word) {
  if (is_one_of(word, {"t", "ts", "time", "times", "timestamp", "timestamps", "stamp"})) return PoseQuantity::time;
  if (const auto p = axis_of(word, {"", "p", "t", "pos"}, PoseQuantity::x); p != PoseQuantity::other) return p;
  if (word == "qw") return PoseQuantity::qw;
  if (const auto q = axis_of(word, {"q"}, PoseQuantity::qx); q != PoseQuantity::other) return q;
  return angle_of(word);
}

// Of several: "header.stamp", "p_rs_r_x", "pose.orientation.w".
PoseQuantity quantity_of_words(const Tokens& tokens) {
  const std::string& last = tokens.back();
  if (any_among(tokens, {"v", "vel", "velocity", "twist", "linear", "angular", "acc", "acceleration", "a", "b", "bias",
                         "cov", "covariance", "omega", "gyro", "std", "sigma", "var", "rate", "seq"}))
    return PoseQuantity::other;
  if (is_one_of(last, {"time", "timestamp", "stamp"})) return PoseQuantity::time;
  if (any_among(tokens, {"q", "quat", "quaternion", "orientation", "rot", "rotation"})) {
    if (last == "w" || last == "qw") return PoseQuantity::qw;
    return axis_of(last, {"", "q"}, PoseQuantity::qx);
  }
  if (last == "qw" || axis_of(last, {"q"}, PoseQuantity::qx) != PoseQuantity::other) return quantity_of_word(last);
  if (any_among(tokens, {"p", "pos", "position", "t", "trans", "translation", "location", "pose"}) &&
      angle_of(last) == PoseQuantity::other)
    return axis_of(last, {"", "p", "t"}, PoseQuantity::x);
  return angle_of(last);
}

PoseQuantity quantity_of(const Tokens& tokens) {
  if (tokens.empty()) return PoseQuantity::other;
  return tokens.size() == 1 ? quantity_of_word(tokens[0]) : quantity_of_words(tokens);
}

double unit_of(PoseQuantity quantity, const std::string& word) {
  if (quantity == PoseQuantity::time) return time_unit(word);
  if (quantity <= PoseQuantity::z) return length_unit(word);
  return quantity >= PoseQuantity::roll && quantity <= PoseQuantity::yaw ? angle_unit(word) : 0;
}

}  // namespace

PoseColumn classify_column(const std::string& name) {
  ColumnName read = read_column_name(name);
  PoseColumn column;
  column.name = name;
  column.quantity = quantity_of(read.tokens);
  if (read.unit.empty() && read.tokens.size() > 1) {  // "yaw_deg", "t_ns", "x_mm", "header.stamp.secs"
    const std::string unit = read.tokens.back();
    read.tokens.pop_back();
    const PoseQuantity quantity = quantity_of(read.tokens);
    if (quantity != PoseQuantity::other && unit_of(quantity, unit) > 0) {
      column.quantity = quantity;
      column.unit = unit_of(quantity, unit);
      column.stem = read.tokens;
      return column;
    }
  }
  if (read.tokens.size() == 1 && is_one_of(read.tokens[0], {"sec", "secs", "nsec", "nsecs", "nanosec", "nanosecs"})) {
    column.unit = time_unit(read.tokens[0]);  // of no quantity without the other half
    return column;
  }
  column.stem = read.tokens;
  if (read.unit.empty() || !units_of(column.quantity)) return column;
  column.unit = unit_of(column.quantity, read.unit);
  if (column.unit == 0) column.unit = unit_of(column.quantity, read.unit.substr(0, read.unit.find_first_of(" ,;")));  // "s since start"
  if (column.unit == 0) column.unknown_unit = read.unit;
  return column;
}

const char* units_of(PoseQuantity quantity) {
  if (quantity == PoseQuantity::time) return kTimeUnits;
  if (quantity <= PoseQuantity::z) return kLengthUnits;
  return quantity >= PoseQuantity::roll && quantity <= PoseQuantity::yaw ? kAngleUnits : nullptr;
}

namespace {

bool is_stamp_part(const PoseColumn& column) {
  return column.quantity == PoseQuantity::time || (column.quantity == PoseQuantity::other && column.unit > 0);
}

// The column with the rest of a second whose whole seconds are in `whole`: "stamp.nsecs" of "stamp.secs". -1: none.
int find_fraction(const std::vector<PoseColumn>& columns, const PoseColumn& whole) {
  if (!is_stamp_part(whole) || whole.unit != 1) return -1;
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (is_stamp_part(columns[i]) && columns[i].unit > 0 && columns[i].unit < 1 && columns[i].stem == whole.stem) return int(i);
  return -1;
}

// As ROS spells the parts of its stamps: "header.stamp.secs", "stamp/nanosec".
bool is_ros_part(const PoseColumn& column) {
  return is_stamp_part(column) && is_one_of(read_column_name(column.name).tokens.back(),
                                            {"sec", "secs", "nsec", "nsecs", "nanosec", "nanosecs"}) &&
         any_among(column.stem, {"stamp"});
}

// Recorders have the time of arrival beside the stamp of the header. The larger number is taken.
int rank_of_stamp(const std::vector<PoseColumn>& columns, std::size_t i) {
  const bool pair = find_fraction(columns, columns[i]) >= 0, header = any_among(columns[i].stem, {"header"});
  if (is_ros_part(columns[i]) && !pair) return 0;
  return 1 + (pair ? 1 : 0) + (header ? 2 : 0);
}

}  // namespace

void ColumnPlaces::choose_stamp() {
  int chosen = -1, rank = -1;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const bool pair = find_fraction(columns, columns[i]) >= 0;
    if (columns[i].quantity != PoseQuantity::time && !pair) continue;
    if (std::any_of(columns.begin(), columns.end(), [&](const PoseColumn& whole) { return find_fraction(columns, whole) == int(i); }))
      continue;
    const int here = rank_of_stamp(columns, i);
    if (here == rank)
      throw std::runtime_error("columns `" + columns[std::size_t(chosen)].name + "` and `" + columns[i].name + "` mean the same");
    if (here > rank) chosen = int(i), rank = here;
  }
  const int fraction = chosen < 0 ? -1 : find_fraction(columns, columns[std::size_t(chosen)]);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (is_stamp_part(columns[i])) columns[i].quantity = PoseQuantity::other;
    if (int(i) == chosen) columns[i].quantity = PoseQuantity::time;
    if (int(i) == fraction) columns[i].quantity = PoseQuantity::fraction;
  }
  half_stamp = rank == 0;
}

ColumnPlaces place_columns(const std::vector<std::string>& names) {
  ColumnPlaces places;
  places.place.fill(-1);
  for (const std::string& name : names) places.columns.push_back(classify_column(name));
  places.choose_stamp();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const PoseQuantity quantity = places.columns[i].quantity;
    if (quantity == PoseQuantity::other) continue;
    int& place = places.place[std::size_t(quantity)];
    if (place >= 0)
      throw std::runtime_error("columns `" + places.columns[std::size_t(place)].name + "` and `" + names[i] + "` mean the same");
    place = int(i);
  }
  return places;
}

std::string ColumnPlaces::left_out() const {
  std::string names;
  for (const PoseColumn& column : columns)
    if (column.quantity == PoseQuantity::other && !column.name.empty())
      names += (names.empty() ? "" : ", ") + column.name;
  return names;
}

bool names_positions(const std::vector<std::string>& names) {
  bool found[3] = {};
  for (const std::string& name : names) {
    const PoseQuantity quantity = classify_column(name).quantity;
    if (quantity >= PoseQuantity::x && quantity <= PoseQuantity::z) found[int(quantity) - int(PoseQuantity::x)] = true;
  }
  return found[0] && found[1] && found[2];
}

}  // namespace rubble
