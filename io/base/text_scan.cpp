#include "io/base/text_scan.h"

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

namespace {

// Characters beyond ASCII stay as they are written: names need no more.
std::string decode_entities(std::string_view text) {
  static constexpr std::pair<std::string_view, char> kEntities[] = {
      {"&lt;", '<'}, {"&gt;", '>'}, {"&amp;", '&'}, {"&quot;", '"'}, {"&apos;", '\''}};
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const auto found = std::find_if(std::begin(kEntities), std::end(kEntities),
                                    [&](const auto& e) { return text.substr(i, e.first.size()) == e.first; });
    if (found == std::end(kEntities)) {
      out += text[i++];
    } else {
      out += found->second;
      i += found->first.size();
    }
  }
  return out;
}

}  // namespace

std::size_t end_of_markup(std::string_view xml, std::size_t at) {
  const auto ends = [&](std::string_view begin, std::string_view end) -> std::size_t {
    if (xml.substr(at, begin.size()) != begin) return 0;
    const std::size_t found = xml.find(end, at + begin.size());
    return found == std::string_view::npos ? xml.size() : found + end.size();
  };
  if (const std::size_t end = ends("<!--", "-->")) return end;
  if (const std::size_t end = ends("<![CDATA[", "]]>")) return end;
  if (const std::size_t end = ends("<?", "?>")) return end;
  char quote = 0;
  for (std::size_t i = at; i < xml.size(); ++i) {
    const char c = xml[i];
    if (quote) quote = c == quote ? '\0' : quote;
    else if (c == '"' || c == '\'') quote = c;
    else if (c == '>') return i + 1;
  }
  return xml.size();
}

bool XmlScanner::next() {
  text_ = all_.size() - rest_.size();
  for (;;) {
    const std::size_t begin = rest_.find('<');
    if (begin == std::string_view::npos) return false;
    const std::size_t end = end_of_markup(rest_, begin);
    std::string_view tag = rest_.substr(begin, end - begin);
    at_ = std::size_t(rest_.data() - all_.data()) + begin;
    rest_.remove_prefix(end);
    if (tag.size() < 3 || tag[1] == '!' || tag[1] == '?') continue;
    if (tag.back() != '>') return false;
    tag = tag.substr(1, tag.size() - 2);
    closes_ = tag[0] == '/';
    if (closes_) tag.remove_prefix(1);
    empty_ = !tag.empty() && tag.back() == '/';
    if (empty_) tag.remove_suffix(1);
    name_ = take_word(tag);
    read_attributes(tag);
    return true;
  }
}

void XmlScanner::read_attributes(std::string_view tag) {
  attributes_.clear();
  for (std::size_t equals = tag.find('='); equals != std::string_view::npos; equals = tag.find('=')) {
    const std::string_view name = trimmed(tag.substr(0, equals));
    tag.remove_prefix(equals + 1);
    tag.remove_prefix(std::min(tag.size(), tag.find_first_not_of(" \t\r\n")));
    if (tag.empty() || (tag[0] != '"' && tag[0] != '\'')) return;
    const std::size_t end = tag.find(tag[0], 1);
    if (end == std::string_view::npos) return;
    attributes_.emplace_back(name, tag.substr(1, end - 1));
    tag.remove_prefix(end + 1);
  }
}

std::string XmlScanner::attribute(std::string_view name) const {
  for (const auto& [key, value] : attributes_)
    if (key == name) return decode_entities(value);
  return {};
}

std::string XmlScanner::text() const {
  static constexpr std::string_view kLiteral = "<![CDATA[", kLiteralEnd = "]]>";
  std::string out;
  for (std::size_t at = text_; at < at_;) {
    const bool markup = all_[at] == '<';
    const std::size_t end = markup ? end_of_markup(all_, at) : std::min(all_.find('<', at), at_);
    if (!markup)
      out += decode_entities(all_.substr(at, end - at));
    else if (all_.substr(at, kLiteral.size()) == kLiteral)
      out += all_.substr(at + kLiteral.size(), end - at - kLiteral.size() - kLiteralEnd.size());
    at = end;
  }
  return out;
}

int XmlScanner::line() const { return 1 + int(std::count(all_.begin(), all_.begin() + std::ptrdiff_t(at_), '\n')); }

}  // namespace rubble
