// Numbers as text that does not depend on the user's locale and reads back to the same bits.
#pragma once

#include <charconv>
#include <cstdint>
#include <string>

namespace rubble {

// The shortest text that reads back to `value`.
inline std::string exact_text(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

// With `digits` after the point.
inline std::string fixed_text(double value, int digits) {
  char text[352];  // the longest double has 309 digits before the point
  return {text,
          std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, digits).ptr};
}

// For sentences, of what somebody wrote: as exact_text(), but 100000 instead of 1e+05.
inline std::string plain_text(double value) {
  char text[32];
  const double size = value < 0 ? -value : value;
  if (!(size >= 1e-6 && size < 1e15)) return exact_text(value);
  return {text, std::to_chars(text, text + sizeof text, value, std::chars_format::fixed).ptr};
}

// For sentences, of what was computed: six digits that count, and all of those before the point.
inline std::string brief_text(double value) {
  const double size = value < 0 ? -value : value;
  if (size >= 1e5 && size < 1e15) return fixed_text(value, 0);
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value, std::chars_format::general, 6).ptr};
}

// Nanoseconds as seconds with nine digits after the point, without rounding. stamp_ns: >= 0.
inline std::string seconds_text(std::int64_t stamp_ns) {
  constexpr std::int64_t kSecond = 1000000000;
  const std::string digits = std::to_string(kSecond + stamp_ns % kSecond);  // a 1 in front
  return std::to_string(stamp_ns / kSecond) + "." + digits.substr(1);
}

// The same with ten digits before the point, and nanoseconds with nineteen digits: sort by name as by number, and are
// as long as stamps of today.
inline std::string sorted_stamp_text(std::int64_t stamp_ns) {
  const std::string digits = std::to_string(stamp_ns);
  return digits.size() < 19 ? std::string(19 - digits.size(), '0') + digits : digits;
}
inline std::string sorted_seconds_text(std::int64_t stamp_ns) {
  const std::string digits = sorted_stamp_text(stamp_ns);
  return digits.substr(0, digits.size() - 9) + "." + digits.substr(digits.size() - 9);
}

// 7 as "000007": sorts by name as by number.
inline std::string index_text(int index) {
  const std::string digits = std::to_string(index);
  return digits.size() < 6 ? std::string(6 - digits.size(), '0') + digits : digits;
}

}  // namespace rubble
