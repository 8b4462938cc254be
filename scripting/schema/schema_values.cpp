// The types a key can have: what is expected, how a value is checked and stored.
#include <algorithm>
#include <cmath>

#include "kernel/base/number_text.h"
#include "scripting/schema/slot_kinds.h"

namespace rubble {
namespace {

constexpr double kTwo63 = 9223372036854775808.0;

std::string limit(double value) {
  return value == std::floor(value) && std::abs(value) < kTwo63
             ? std::to_string(static_cast<std::int64_t>(value))
             : exact_text(value);
}

std::string range_words(const Range& r) {
  const bool low = std::isfinite(r.min), high = std::isfinite(r.max);
  if (low && high && r.above_min) return " above " + limit(r.min) + ", up to " + limit(r.max);
  if (low && high) return " from " + limit(r.min) + " to " + limit(r.max);
  if (low) return (r.above_min ? " above " : " of at least ") + limit(r.min);
  return high ? " of at most " + limit(r.max) : "";
}

bool within(const Range& r, double value) {
  return std::isfinite(value) && value <= r.max && (r.above_min ? value > r.min : value >= r.min);
}

std::string choice_words(const Choice& choice) {
  std::string words = "one of ";
  for (std::size_t i = 0; i < choice.names.size(); ++i)
    words += (i ? ", \"" : "\"") + choice.names[i] + "\"";
  return words;
}

// What came of an attempt to store a value.
enum class Outcome { stored, wrong_type, out_of_range };

Outcome store_integer(const Range& range, const Value& value, std::int64_t& out) {
  if (!value.is_number()) return Outcome::wrong_type;
  if (value.kind == Value::Kind::number) {
    if (value.number != std::floor(value.number)) return Outcome::wrong_type;
    if (!(std::abs(value.number) < kTwo63)) return Outcome::out_of_range;
  }
  if (!within(range, value.number)) return Outcome::out_of_range;
  out =
      value.kind == Value::Kind::integer ? value.integer : static_cast<std::int64_t>(value.number);
  return Outcome::stored;
}

Outcome store_number(const Range& range, const Value& value, double& out) {
  if (!value.is_number()) return Outcome::wrong_type;
  if (!within(range, value.number)) return Outcome::out_of_range;
  out = value.number;
  return Outcome::stored;
}

Outcome store_vector(const Range& range, const Value& value, Vec3& out) {
  static const char* const kNames[] = {"x", "y", "z"};
  if (value.kind != Value::Kind::table || !value.strange_keys.empty()) return Outcome::wrong_type;
  const bool listed = value.items.size() == 3 && value.fields.empty();
  if (!listed && (value.fields.size() != 3 || !value.items.empty())) return Outcome::wrong_type;
  Vec3 v;
  for (int i = 0; i < 3; ++i) {
    const Value* part = listed ? &value.items[std::size_t(i)] : value.find(kNames[i]);
    if (!part) return Outcome::wrong_type;
    const Outcome outcome = store_number(range, *part, v[i]);
    if (outcome != Outcome::stored) return outcome;
  }
  out = v;
  return Outcome::stored;
}

Outcome store_pair(const Range& range, const Value& value, NumberPair& out) {
  NumberPair pair;
  if (value.is_number()) {
    const Outcome outcome = store_number(range, value, pair[0]);
    if (outcome == Outcome::stored) out = {pair[0], pair[0]};
    return outcome;
  }
  if (value.kind != Value::Kind::table || value.items.size() != 2 || !value.fields.empty() ||
      !value.strange_keys.empty())
    return Outcome::wrong_type;
  for (std::size_t i = 0; i < 2; ++i) {
    const Outcome outcome = store_number(range, value.items[i], pair[i]);
    if (outcome != Outcome::stored) return outcome;
  }
  if (pair[0] > pair[1]) return Outcome::out_of_range;
  out = pair;
  return Outcome::stored;
}

Outcome store_strings(const Value& value, std::vector<std::string>& out) {
  if (value.kind != Value::Kind::table || !value.fields.empty() || !value.strange_keys.empty())
    return Outcome::wrong_type;
  std::vector<std::string> strings;
  for (const Value& item : value.items) {
    if (item.kind != Value::Kind::text) return Outcome::wrong_type;
    strings.push_back(item.text);
  }
  out = std::move(strings);
  return Outcome::stored;
}

Outcome store_numbers(const Range& range, const Value& value, std::vector<double>& out) {
  if (value.kind != Value::Kind::table || !value.fields.empty() || !value.strange_keys.empty())
    return Outcome::wrong_type;
  std::vector<double> numbers;
  for (const Value& item : value.items) {
    numbers.emplace_back();
    const Outcome outcome = store_number(range, item, numbers.back());
    if (outcome != Outcome::stored) return outcome;
  }
  out = std::move(numbers);
  return Outcome::stored;
}

Outcome store_choice(const Choice& choice, const Value& value) {
  if (value.kind != Value::Kind::text) return Outcome::wrong_type;
  const auto at = std::find(choice.names.begin(), choice.names.end(), value.text);
  if (at == choice.names.end()) return Outcome::out_of_range;
  choice.set(int(at - choice.names.begin()));
  return Outcome::stored;
}

Outcome store_map(const Value& value, TextMap& out) {
  if (value.kind != Value::Kind::table || !value.items.empty() || !value.strange_keys.empty())
    return Outcome::wrong_type;
  TextMap map;
  for (const auto& [name, text] : value.fields) {
    if (text.kind != Value::Kind::text) return Outcome::wrong_type;
    map.emplace_back(name, text.text);
  }
  out = std::move(map);
  return Outcome::stored;
}

Outcome store_map(const Range& range, const Value& value, NumberMap& out) {
  if (value.kind != Value::Kind::table || !value.items.empty() || !value.strange_keys.empty())
    return Outcome::wrong_type;
  NumberMap map;
  for (const auto& [name, number] : value.fields) {
    const Outcome outcome = store_number(range, number, map.emplace_back(name, 0.0).second);
    if (outcome != Outcome::stored) return outcome;
  }
  out = std::move(map);
  return Outcome::stored;
}

Outcome store_word_or_file(const WordOrFile& to, const Value& value) {
  if (value.kind == Value::Kind::text) {
    const auto at = std::find(to.words.begin(), to.words.end(), value.text);
    if (at == to.words.end()) return Outcome::out_of_range;
    *to.word = int(at - to.words.begin());
    to.file->clear();
    return Outcome::stored;
  }
  const Value* file = value.kind == Value::Kind::table ? value.find(to.key) : nullptr;
  const bool alone = value.items.empty() && value.fields.size() == 1 && value.strange_keys.empty();
  if (!file || !alone || file->kind != Value::Kind::text || file->text.empty())
    return Outcome::wrong_type;
  *to.file = file->text;
  return Outcome::stored;
}

Outcome store_place(const Range& range, const PlaceSlot& to, const Value& value) {
  const Value* marker = value.kind == Value::Kind::table ? value.find("find_void") : nullptr;
  if (marker && value.fields.size() == 1 && marker->kind == Value::Kind::table) {
    VoidPlace place;
    std::vector<Diagnostic> mistakes;
    read_table(void_place_schema(place), *marker, mistakes);
    if (!mistakes.empty()) return Outcome::wrong_type;
    *to.in_void = place;
    if (to.maybe) to.maybe->reset();
    return Outcome::stored;
  }
  Vec3 v;
  const Outcome outcome = store_vector(range, value, v);
  if (outcome != Outcome::stored) return outcome;
  to.in_void->reset();
  if (to.point) *to.point = v;
  if (to.maybe) *to.maybe = v;
  return Outcome::stored;
}

Outcome store(const Range& range, const Slot& slot, const Value& value);

template <typename T>
Outcome store_as(const Range& range, const T& to, const Value& value) {
  if constexpr (is_any<T, bool*, Negated>) {
    if (value.kind != Value::Kind::boolean) return Outcome::wrong_type;
    if constexpr (std::is_same_v<T, Negated>)
      *to.member = !value.boolean;
    else
      *to = value.boolean;
    return Outcome::stored;
  } else if constexpr (is_integer<T>) {
    std::int64_t integer = 0;
    const Outcome outcome = store_integer(range, value, integer);
    if (outcome == Outcome::stored) *to = static_cast<std::remove_pointer_t<T>>(integer);
    return outcome;
  } else if constexpr (is_optional<T>) {
    typename std::remove_pointer_t<T>::value_type plain{};
    const Outcome outcome = store(range, Slot(&plain), value);
    if (outcome == Outcome::stored) *to = plain;
    return outcome;
  } else if constexpr (is_number<T>) {
    return store_number(range, value, *to);
  } else if constexpr (is_text<T>) {
    if (value.kind != Value::Kind::text) return Outcome::wrong_type;
    *to = value.text;
    return Outcome::stored;
  } else if constexpr (is_vector<T>) {
    return store_vector(range, value, *to);
  } else if constexpr (is_pair<T>) {
    return store_pair(range, value, *to);
  } else if constexpr (std::is_same_v<T, Choice>) {
    return store_choice(to, value);
  } else if constexpr (std::is_same_v<T, StringOrList>) {
    if (value.kind != Value::Kind::text) return store_strings(value, *to.member);
    *to.member = {value.text};
    return Outcome::stored;
  } else if constexpr (std::is_same_v<T, WordOrFile>) {
    return store_word_or_file(to, value);
  } else if constexpr (std::is_same_v<T, std::vector<double>*>) {
    return store_numbers(range, value, *to);
  } else if constexpr (std::is_same_v<T, PlaceSlot>) {
    return store_place(range, to, value);
  } else if constexpr (std::is_same_v<T, Value*>) {
    if (value.kind != Value::Kind::table || !value.strange_keys.empty()) return Outcome::wrong_type;
    *to = value;
    return Outcome::stored;
  } else if constexpr (is_any<T, TableList, NamedTables>) {
    return Outcome::wrong_type;  // read table by table, by whoever knows its items
  } else if constexpr (std::is_same_v<T, TextMap*>) {
    return store_map(value, *to);
  } else if constexpr (std::is_same_v<T, NumberMap*>) {
    return store_map(range, value, *to);
  } else {
    return store_strings(value, *to);
  }
}

Outcome store(const Range& range, const Slot& slot, const Value& value) {
  return std::visit([&](const auto& to) { return store_as(range, to, value); }, slot);
}

template <typename T>
std::string expected_as(const Key& key, const T& slot) {
  const std::string range = range_words(key.range);
  if constexpr (is_any<T, bool*, Negated>) return "true or false";
  if constexpr (is_integer<T>) return "an integer" + range;
  if constexpr (is_number<T>) return "a number" + range;
  if constexpr (is_text<T>) return "a string";
  if constexpr (is_vector<T>)
    return "three numbers {x, y, z}" + (range.empty() ? "" : ", each" + range);
  if constexpr (is_pair<T>)
    return "a number or {min, max}" + (range.empty() ? "" : ", each" + range);
  if constexpr (std::is_same_v<T, Choice>) return choice_words(slot);
  if constexpr (std::is_same_v<T, WordOrFile>) {
    std::string words;
    for (const std::string& word : slot.words) words += "\"" + word + "\" or ";
    return words + "{ " + slot.key + " = \"FILE\" }";
  }
  if constexpr (std::is_same_v<T, std::vector<double>*>)
    return "a list of numbers" + (range.empty() ? "" : ", each" + range);
  if constexpr (std::is_same_v<T, PlaceSlot>)
    return "three numbers {x, y, z}" + (range.empty() ? "" : ", each" + range) +
           ", or a place in a void";
  if constexpr (std::is_same_v<T, Value*>) return "a table";
  if constexpr (std::is_same_v<T, StringOrList>) return "a string or a list of strings";
  if constexpr (std::is_same_v<T, TableList>) return "a list of tables";
  if constexpr (std::is_same_v<T, NamedTables>)
    return "tables by name { " + slot.example + " = { ... } }";
  if constexpr (std::is_same_v<T, TextMap*>) return "a table { name = \"text\" }";
  if constexpr (std::is_same_v<T, NumberMap*>) return "a table { name = number }" + (range.empty() ? "" : ", each" + range);
  return "a list of strings";
}

// The first item of a list of numbers that cannot be stored, "1200 as item 5 of 12"; empty: it is the list itself.
std::string found_item(const Range& range, const Value& value) {
  double number = 0;
  for (std::size_t i = 0; value.fields.empty() && value.strange_keys.empty() && i < value.items.size(); ++i)
    if (store_number(range, value.items[i], number) != Outcome::stored)
      return describe(value.items[i]) + " as item " + std::to_string(i + 1) + " of " + std::to_string(value.items.size());
  return "";
}

std::string found_words(const Value& value) {
  // Show a short list of numbers in full: the mistake is in one of them.
  if (value.kind != Value::Kind::table || value.items.empty() || value.items.size() > 3)
    return describe(value);
  if (!value.fields.empty() || !value.strange_keys.empty()) return describe(value);
  std::string words = "{";
  for (const Value& item : value.items) {
    if (item.kind == Value::Kind::table) return describe(value);
    words += (words.size() > 1 ? ", " : "") + describe(item);
  }
  return words + "}";
}

}  // namespace

std::string describe_expected(const Key& key) {
  if (key.kind == KeyKind::group) return "a table";
  if (key.kind == KeyKind::list) return "a list of tables";
  return std::visit([&](const auto& slot) { return expected_as(key, slot); }, key.bind(0));
}

std::optional<Diagnostic> write_slot(const Key& key, const Slot& slot, const Value& value,
                                     const std::string& shown_path) {
  const Outcome outcome = store(key.range, slot, value);
  if (outcome == Outcome::stored) return std::nullopt;
  Diagnostic d;
  d.key = shown_path;
  d.message = outcome == Outcome::wrong_type ? "wrong type" : "out of range";
  d.expected = std::visit([&](const auto& to) { return expected_as(key, to); }, slot);
  d.found = found_words(value);
  if (std::holds_alternative<std::vector<double>*>(slot) && value.items.size() > 3)
    if (const std::string item = found_item(key.range, value); !item.empty()) d.found = item;
  const bool is_word = std::holds_alternative<WordOrFile>(slot) && value.kind == Value::Kind::text;
  if (is_word) d.message = "unknown choice";
  if (const auto* choice = std::get_if<Choice>(&slot); choice && value.kind == Value::Kind::text) {
    d.message = "unknown choice";
    const std::string near = nearest_name(value.text, choice->names);
    if (!near.empty()) d.hint = "did you mean \"" + near + "\"?";
  }
  return d;
}

}  // namespace rubble
