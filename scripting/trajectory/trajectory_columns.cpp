#include "scripting/trajectory/trajectory_columns.h"

#include <algorithm>
#include <stdexcept>

#include "kernel/base/portable_math.h"
#include "kernel/base/tables/text_table.h"

namespace rubble {
namespace {

using Tokens = std::vector<std::string>;

bool among(const std::string& word, std::initializer_list<const char*> words) {
  return std::any_of(words.begin(), words.end(), [&](const char* w) { return word == w; });
}

bool any_among(const Tokens& tokens, std::initializer_list<const char*> words) {
  return std::any_of(tokens.begin(), tokens.end(), [&](const std::string& t) { return among(t, words); });
}

// 0: the word is no unit of time.
double time_unit(const std::string& word) {
  if (among(word, {"s", "sec", "secs", "second", "seconds"})) return 1;
  if (among(word, {"ms", "msec", "msecs", "millis", "milliseconds"})) return 1e-3;
  if (among(word, {"us", "usec", "usecs", "micros", "microseconds"})) return 1e-6;
  if (among(word, {"ns", "nsec", "nsecs", "nanos", "nanosec", "nanosecs", "nanoseconds"})) return 1e-9;
  return 0;
}

double length_unit(const std::string& word) {
  if (among(word, {"m", "meter", "meters", "metre", "metres"})) return 1;
  if (word == "cm") return 1e-2;
  return word == "mm" ? 1e-3 : 0;
}

double angle_unit(const std::string& word) {
  if (among(word, {"rad", "rads", "radian", "radians"})) return 1;
  return among(word, {"deg", "degs", "degree", "degrees"}) ? portable::kPi / 180 : 0;
}

// "p_RS_R_x [m]": the words p, rs, r, x, and the unit m.
struct ColumnName {
  Tokens tokens;
  std::string unit;  // what stands in brackets
};

ColumnName read_name(const std::string& name) {
  ColumnName read;
  std::string word, low = lower_case(name);
  const std::size_t open = low.find_first_of("[(");
  if (open != std::string::npos && open > 0) {
    const std::size_t close = low.find_first_of("])", open);
    read.unit = std::string(trimmed(low.substr(open + 1, std::min(close, low.size()) - open - 1)));
    low.resize(open);
  }
  for (const char c : low + "_") {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    if (letter) word += c;
    if (!letter && !word.empty()) read.tokens.push_back(std::move(word)), word.clear();
  }
  return read;
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
  if (among(word, {"t", "ts", "time", "times", "timestamp", "timestamps", "stamp"})) return PoseQuantity::time;
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
  if (among(last, {"time", "timestamp", "stamp"})) return PoseQuantity::time;
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

std::vector<std::string> join_units(const std::vector<std::string_view>& words) {
  std::vector<std::string> joined;
  bool open = false;
  for (const std::string_view word : words) {
    const bool unit = !word.empty() && (word[0] == '[' || word[0] == '(');
    if ((unit || open) && !joined.empty())
      joined.back() += " " + std::string(word);
    else
      joined.emplace_back(word);
    if (unit) open = true;
    if (open) open = word.find_first_of("])") == std::string_view::npos;
  }
  return joined;
}

PoseColumn classify_column(const std::string& name) {
  ColumnName read = read_name(name);
  PoseColumn column;
  column.name = name;
  column.quantity = quantity_of(read.tokens);
  if (read.unit.empty() && read.tokens.size() > 1) {  // "yaw_deg", "t_ns", "x_mm"
    const std::string unit = read.tokens.back();
    read.tokens.pop_back();
    const PoseQuantity quantity = quantity_of(read.tokens);
    if (quantity != PoseQuantity::other && unit_of(quantity, unit) > 0) {
      column.quantity = quantity;
      column.unit = unit_of(quantity, unit);
      return column;
    }
  }
  if (!read.unit.empty() && column.quantity != PoseQuantity::other) column.unit = unit_of(column.quantity, read.unit);
  return column;
}

ColumnPlaces place_columns(const std::vector<std::string>& names) {
  ColumnPlaces places;
  places.place.fill(-1);
  for (const std::string& name : names) {
    PoseColumn column = classify_column(name);
    const int here = int(places.columns.size());
    places.columns.push_back(column);
    if (column.quantity == PoseQuantity::other) continue;
    int& place = places.place[std::size_t(column.quantity)];
    // `rostopic echo -p` has the time of arrival before the stamp of the header.
    const bool arrival = place >= 0 && column.quantity == PoseQuantity::time && here > 0 &&
                         lower_case(name).find("header") != std::string::npos;
    if (place >= 0 && !arrival)
      throw std::runtime_error("columns `" + places.columns[std::size_t(place)].name + "` and `" + name +
                               "` mean the same");
    if (place >= 0) places.columns[std::size_t(place)].quantity = PoseQuantity::other;
    place = here;
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
