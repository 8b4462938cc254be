#include "kernel/base/tables/text_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace rubble {
namespace {

constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::string_view without_quotes(std::string_view word) {
  const bool quoted = word.size() >= 2 && word.front() == '"' && word.back() == '"';
  return quoted ? trimmed(word.substr(1, word.size() - 2)) : word;
}

// Both are unsigned words in lower case.
std::optional<double> parse_special(std::string_view word) {
  if (word == "nan") return std::numeric_limits<double>::quiet_NaN();
  if (word == "inf" || word == "infinity") return std::numeric_limits<double>::infinity();
  return std::nullopt;
}

// A decimal number that std::from_chars calls out of range: 0 if it is too small, else none.
std::optional<double> parse_extreme(std::string_view word) {
  const std::size_t exponent = word.find_first_of("eE");
  const bool small = exponent != std::string_view::npos && word.substr(exponent + 1, 1) == "-";
  return small ? std::optional<double>(0.0) : std::nullopt;
}

}  // namespace

std::string_view skip_byte_order_mark(std::string_view text) {
  if (text.substr(0, kByteOrderMark.size()) == kByteOrderMark) text.remove_prefix(kByteOrderMark.size());
  return text;
}

bool is_utf16(std::string_view text) {
  return text.substr(0, 2) == "\xff\xfe" || text.substr(0, 2) == "\xfe\xff";
}

std::string lower_case(std::string_view text) {
  std::string low(text);
  for (char& c : low)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  return low;
}

std::string_view trimmed(std::string_view text) {
  constexpr const char* kWhite = " \t\r\n\f\v";
  const std::size_t begin = text.find_first_not_of(kWhite);
  return begin == std::string_view::npos ? std::string_view() : text.substr(begin, text.find_last_not_of(kWhite) - begin + 1);
}

std::optional<double> parse_number(std::string_view word) {
  double sign = 1;
  if (!word.empty() && (word[0] == '+' || word[0] == '-')) {
    sign = word[0] == '-' ? -1 : 1;
    word.remove_prefix(1);
  }
  if (word.empty()) return std::nullopt;
  if (!is_digit(word[0]) && word[0] != '.') {
    const auto special = parse_special(lower_case(word));
    return special ? std::optional<double>(sign * *special) : std::nullopt;
  }
  std::string fortran;
  if (const std::size_t d = word.find_first_of("dD"); d != std::string_view::npos) {
    fortran = word;
    fortran[d] = 'e';
    word = fortran;
  }
  double value = 0;
  const char* const end = word.data() + word.size();
  const auto [last, failed] = std::from_chars(word.data(), end, value);
  if (last != end || failed == std::errc::invalid_argument) return std::nullopt;
  if (failed == std::errc::result_out_of_range) {
    const auto extreme = parse_extreme(word);
    if (!extreme) return std::nullopt;
    value = *extreme;
  }
  return sign * value;
}

std::optional<std::int64_t> parse_scaled_integer(std::string_view word, int digits) {
  const auto approximate = parse_number(word);
  if (!approximate || !std::isfinite(*approximate)) return std::nullopt;
  double scaled = *approximate;
  for (int i = 0; i < digits; ++i) scaled *= 10;
  if (std::abs(scaled) > 9e18) return std::nullopt;
  const bool negative = word[0] == '-';
  if (word[0] == '-' || word[0] == '+') word.remove_prefix(1);
  std::uint64_t value = 0;  // wraps round where digits before an exponent are too many; it is not used then
  int after_point = -1;  // digits taken after the point
  for (const char c : word) {
    if (c == '.') {
      after_point = 0;
    } else if (!is_digit(c)) {
      return std::int64_t(std::llround(scaled));  // it has an exponent
    } else if (after_point < digits) {
      value = 10 * value + std::uint64_t(c - '0');
      if (after_point >= 0) ++after_point;
    } else {
      if (after_point == digits && c >= '5') ++value;
      after_point = digits + 1;
    }
  }
  for (int i = std::max(0, after_point); i < digits; ++i) value *= 10;
  return negative ? -std::int64_t(value) : std::int64_t(value);
}

std::vector<std::string_view> split_lines(std::string_view text) {
  text = skip_byte_order_mark(text);
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    lines.push_back(text.substr(0, end));
    const bool pair = text.substr(end, 2) == "\r\n";
    text.remove_prefix(std::min(end + (pair ? 2 : 1), text.size()));
  }
  return lines;
}

TextRow split_words(std::string_view text, int line) {
  TextRow row;
  row.line = line;
  for (const char separator : {';', ','})
    if (row.separator == ' ' && text.find(separator) != std::string_view::npos) row.separator = separator;
  const auto ends_word = [&](char c) { return row.separator == ' ' ? is_blank(c) : c == row.separator; };
  std::size_t begin = 0;
  bool quoted = false;
  for (std::size_t i = 0; i <= text.size(); ++i) {
    if (i < text.size() && text[i] == '"') quoted = !quoted;
    if (i < text.size() && (quoted || !ends_word(text[i]))) continue;
    const std::string_view word = without_quotes(trimmed(text.substr(begin, i - begin)));
    if (row.separator != ' ' || !word.empty()) row.words.push_back(word);
    begin = i + 1;
  }
  return row;
}

TextTable read_text_table(std::string_view text) {
  TextTable table;
  int number = 0;
  for (std::string_view line : split_lines(text)) {
    ++number;
    line = trimmed(line);
    if (!line.empty() && (line[0] == '#' || line[0] == '%')) {
      line.remove_prefix(std::min(line.find_first_not_of("#%"), line.size()));
      table.comments.push_back(split_words(trimmed(line), number));
      continue;
    }
    line = trimmed(line.substr(0, line.find('#')));
    if (!line.empty()) table.rows.push_back(split_words(line, number));
  }
  return table;
}

}  // namespace rubble
