#include "scripting/values/value.h"

#include <algorithm>

#include "kernel/base/number_text.h"

namespace rubble {
namespace {

constexpr std::size_t kLongestQuote = 40;  // bytes of a string shown in a message

bool before(const std::pair<std::string, Value>& field, const std::string& key) {
  return field.first < key;
}

std::string quoted(const std::string& text) {
  std::string shown = "\"";
  for (std::size_t i = 0; i < text.size() && i < kLongestQuote; ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    shown += byte < 32 || byte == 127 ? '?' : text[i];
  }
  return shown + (text.size() > kLongestQuote ? "...\"" : "\"");
}

std::string describe_table(const Value& value) {
  if (value.is_empty_table()) return "an empty table";
  const std::size_t count = value.items.size();
  if (value.fields.empty() && value.strange_keys.empty())
    return "a list of " + std::to_string(count) + (count == 1 ? " item" : " items");
  return count == 0 ? "a table of named fields" : "a table of both items and named fields";
}

}  // namespace

Value Value::of_kind(Kind kind) {
  Value v;
  v.kind = kind;
  return v;
}

Value Value::make_boolean(bool value) {
  Value v = of_kind(Kind::boolean);
  v.boolean = value;
  return v;
}

Value Value::make_integer(std::int64_t value) {
  Value v = of_kind(Kind::integer);
  v.integer = value;
  v.number = double(value);
  return v;
}

Value Value::make_number(double value) {
  Value v = of_kind(Kind::number);
  v.number = value;
  return v;
}

Value Value::make_text(std::string value) {
  Value v = of_kind(Kind::text);
  v.text = std::move(value);
  return v;
}

const Value* Value::find(const std::string& key) const {
  const auto at = std::lower_bound(fields.begin(), fields.end(), key, before);
  return at != fields.end() && at->first == key ? &at->second : nullptr;
}

void Value::set(const std::string& key, Value value) {
  const auto at = std::lower_bound(fields.begin(), fields.end(), key, before);
  if (at != fields.end() && at->first == key)
    at->second = std::move(value);
  else
    fields.emplace(at, key, std::move(value));
}

std::string describe(const Value& value) {
  switch (value.kind) {
    case Value::Kind::nil:
      return "nothing";
    case Value::Kind::boolean:
      return value.boolean ? "true" : "false";
    case Value::Kind::integer:
      return std::to_string(value.integer);
    case Value::Kind::number:
      return exact_text(value.number);
    case Value::Kind::text:
      return "the string " + quoted(value.text);
    case Value::Kind::table:
      return describe_table(value);
    case Value::Kind::other:
      return value.text;
  }
  return {};
}

}  // namespace rubble
