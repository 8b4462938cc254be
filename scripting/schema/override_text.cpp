#include "scripting/schema/override_text.h"

#include <charconv>
#include <vector>

#include "kernel/base/tables/text_table.h"

namespace rubble {
namespace {

bool is_quotation_mark(char c) { return c == '"' || c == '\''; }

bool is_quoted(const std::string& word) {
  return word.size() > 1 && is_quotation_mark(word.front()) && word.find(word.front(), 1) == word.size() - 1;
}

Value parse_text(const std::string& word) {
  return Value::make_text(is_quoted(word) ? word.substr(1, word.size() - 2) : word);
}

// An integer, a number, true or false, otherwise a string.
Value parse_word(const std::string& word) {
  const char* const end = word.data() + word.size();
  std::int64_t integer = 0;
  auto result = std::from_chars(word.data(), end, integer);
  if (result.ec == std::errc() && result.ptr == end) return Value::make_integer(integer);
  double number = 0;
  result = std::from_chars(word.data(), end, number);
  if (result.ec == std::errc() && result.ptr == end) return Value::make_number(number);
  if (word == "true" || word == "false") return Value::make_boolean(word == "true");
  return parse_text(word);
}

// At commas outside of quotation marks. A mark that is not closed is a letter as any other.
std::vector<std::string> split_at_commas(const std::string& text) {
  std::vector<std::string> words(1);
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool opens = is_quotation_mark(text[i]) && trimmed(words.back()).empty();
    const std::size_t close = opens ? text.find(text[i], i + 1) : std::string::npos;
    if (close != std::string::npos) {
      words.back() += text.substr(i, close - i + 1);
      i = close;
    } else if (text[i] == ',') {
      words.emplace_back();
    } else {
      words.back() += text[i];
    }
  }
  return words;
}

Value parse_list(std::string text, bool words_are_text) {
  if (text.size() > 1 && text.front() == '{' && text.back() == '}') text = text.substr(1, text.size() - 2);
  Value list = Value::make_table();
  if (trimmed(text).empty()) return list;
  for (const std::string& piece : split_at_commas(text)) {
    const std::string word(trimmed(piece));
    list.items.push_back(words_are_text ? parse_text(word) : parse_word(word));
  }
  return list;
}

}  // namespace

Value parse_override(const Slot& slot, const std::string& text) {
  if (std::holds_alternative<std::string*>(slot) || std::holds_alternative<Choice>(slot) ||
      std::holds_alternative<std::optional<std::string>*>(slot))
    return parse_text(text);
  if (std::holds_alternative<std::vector<std::string>*>(slot) || std::holds_alternative<StringOrList>(slot))
    return parse_list(text, true);
  if (!is_quoted(text) && text.find_first_of(",{") != std::string::npos) return parse_list(text, false);
  return parse_word(text);
}

}  // namespace rubble
