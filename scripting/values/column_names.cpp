#include "scripting/values/column_names.h"

#include <algorithm>

#include "kernel/base/portable_math.h"
#include "kernel/base/tables/text_table.h"

namespace rubble {

bool is_one_of(const std::string& word, std::initializer_list<const char*> words) {
  return std::any_of(words.begin(), words.end(), [&](const char* w) { return word == w; });
}

// The micro sign and the Greek letter both are in use.
double time_unit(const std::string& word) {
  if (is_one_of(word, {"s", "sec", "secs", "second", "seconds"})) return 1;
  if (is_one_of(word, {"ms", "msec", "msecs", "millis", "millisec", "millisecs", "millisecond", "milliseconds"})) return 1e-3;
  if (is_one_of(word, {"us", "usec", "usecs", "micros", "microsec", "microsecs", "microsecond", "microseconds",
                       "\xc2\xb5s", "\xce\xbcs"}))
    return 1e-6;
  if (is_one_of(word, {"ns", "nsec", "nsecs", "nanos", "nanosec", "nanosecs", "nanosecond", "nanoseconds"})) return 1e-9;
  if (is_one_of(word, {"min", "mins", "minute", "minutes"})) return 60;
  return is_one_of(word, {"h", "hr", "hrs", "hour", "hours"}) ? 3600 : 0;
}

double length_unit(const std::string& word) {
  if (is_one_of(word, {"m", "meter", "meters", "metre", "metres"})) return 1;
  if (is_one_of(word, {"cm", "centimeter", "centimeters", "centimetre", "centimetres"})) return 1e-2;
  if (is_one_of(word, {"mm", "millimeter", "millimeters", "millimetre", "millimetres"})) return 1e-3;
  if (is_one_of(word, {"km", "kilometer", "kilometers", "kilometre", "kilometres"})) return 1e3;
  if (is_one_of(word, {"ft", "foot", "feet"})) return 0.3048;
  return is_one_of(word, {"in", "inch", "inches"}) ? 0.0254 : 0;
}

double angle_unit(const std::string& word) {
  if (is_one_of(word, {"rad", "rads", "radian", "radians"})) return 1;
  return is_one_of(word, {"deg", "degs", "degree", "degrees", "\xc2\xb0"}) ? portable::kPi / 180 : 0;
}

ColumnName read_column_name(const std::string& name) {
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

}  // namespace rubble
