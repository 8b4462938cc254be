#include "io/import/text_scan.h"

#include <algorithm>
#include <charconv>

namespace rubble {
namespace {

constexpr std::string_view kBlanks = " \t\v\f\r\n";
constexpr std::string_view kMark = "\xef\xbb\xbf";
constexpr std::size_t kWholeDigits = 5, kFractionDigits = 15;
constexpr double kTenths[kFractionDigits + 1] = {1,    1e-1, 1e-2, 1e-3,  1e-4,  1e-5,  1e-6,  1e-7,
                                                 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14, 1e-15};

std::size_t count_digits(std::string_view text) {
  std::size_t n = 0;
  while (n < text.size() && text[n] >= '0' && text[n] <= '9') ++n;
  return n;
}

std::uint64_t digits_value(std::string_view digits) {
  std::uint64_t value = 0;
  for (const char c : digits) value = value * 10 + std::uint64_t(c - '0');
  return value;
}

// The sum described in the header; nothing where it does not apply. unsigned_word: without its sign.
std::optional<double> read_short_decimal(std::string_view unsigned_word) {
  const std::size_t whole = count_digits(unsigned_word);
  if (whole > kWholeDigits) return std::nullopt;
  std::string_view rest = unsigned_word.substr(whole);
  std::size_t fraction = 0;
  if (!rest.empty() && rest[0] == '.') fraction = count_digits(rest.substr(1)), rest.remove_prefix(1 + fraction);
  if (!rest.empty() || whole + fraction == 0) return std::nullopt;
  auto value = float(digits_value(unsigned_word.substr(0, whole)));
  if (fraction > 0) {
    const std::size_t used = std::min(fraction, kFractionDigits);
    value += float(double(digits_value(unsigned_word.substr(whole + 1, used))) * kTenths[used]);
  }
  return double(value);
}

}  // namespace

LineScanner::LineScanner(std::string_view text, bool joins_lines) : rest_(text), joins_lines_(joins_lines) {
  if (rest_.substr(0, kMark.size()) == kMark) rest_.remove_prefix(kMark.size());
}

bool LineScanner::take() {
  if (rest_.empty()) return false;
  const std::size_t end = rest_.find_first_of("\r\n");
  line_ = rest_.substr(0, end);
  ++lines_;
  if (end == std::string_view::npos) return rest_ = {}, true;
  rest_.remove_prefix(end + (rest_.substr(end, 2) == "\r\n" ? 2 : 1));
  return true;
}

bool LineScanner::next() {
  joined_.clear();
  if (!take()) return false;
  first_ = lines_;
  while (joins_lines_ && !line_.empty() && line_.back() == '\\') {
    joined_ += std::string(line_.substr(0, line_.size() - 1)) + " ";
    if (!take()) return true;
    if (line_.empty() || line_.back() != '\\') joined_ += line_;
  }
  return true;
}

std::string_view take_word(std::string_view& text) {
  text.remove_prefix(std::min(text.size(), text.find_first_not_of(kBlanks)));
  const std::string_view word = text.substr(0, text.find_first_of(kBlanks));
  text.remove_prefix(word.size());
  return word;
}

std::vector<std::string_view> split_words(std::string_view text) {
  std::vector<std::string_view> words;
  for (std::string_view word = take_word(text); !word.empty(); word = take_word(text)) words.push_back(word);
  return words;
}

std::optional<double> read_real(std::string_view word) {
  const bool minus = !word.empty() && word[0] == '-';
  const std::string_view plain = word.substr(minus || (!word.empty() && word[0] == '+') ? 1 : 0);
  if (plain.empty() || plain[0] == '-' || plain[0] == '+') return std::nullopt;
  std::optional<double> value = read_short_decimal(plain);
  if (!value) {
    double exact = 0;
    const auto [end, failed] = std::from_chars(plain.data(), plain.data() + plain.size(), exact);
    if (end != plain.data() + plain.size() || failed == std::errc::invalid_argument) return std::nullopt;
    if (failed != std::errc()) exact = plain.find("e-") == plain.npos && plain.find("E-") == plain.npos ? 1e300 * 1e300 : 0;
    value = exact;
  }
  return minus ? -*value : *value;
}

std::optional<std::int64_t> read_integer(std::string_view word) {
  if (!word.empty() && word[0] == '+') word.remove_prefix(1);
  std::int64_t value = 0;
  const auto [end, failed] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (failed != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

}  // namespace rubble
