// A piece of a script or a JSON file as plain data, before a schema gives it a meaning.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace rubble {

struct Value {
  enum class Kind { nil, boolean, integer, number, text, table, other };

  Kind kind = Kind::nil;                              // which of the members below count
  bool boolean = false;                               // of a boolean
  std::int64_t integer = 0;                           // of an integer
  double number = 0;                                  // of integers, too
  std::string text;                                   // of `other`: what it is, e.g. "a function"
  std::vector<Value> items;                           // keys 1 .. n of a table
  std::vector<std::pair<std::string, Value>> fields;  // its string keys, sorted
  std::vector<std::string> strange_keys;              // described, e.g. "the key 2.5"

  static Value make_boolean(bool v);
  static Value make_integer(std::int64_t v);
  static Value make_number(double v);
  static Value make_text(std::string v);
  static Value make_table() { return of_kind(Kind::table); }
  static Value of_kind(Kind kind);

  bool is_number() const { return kind == Kind::integer || kind == Kind::number; }
  bool is_empty_table() const { return items.empty() && fields.empty() && strange_keys.empty(); }
  const Value* find(const std::string& key) const;  // null when there is none
  void set(const std::string& key, Value value);    // keeps the order
};

// For "found ...": `the number 2.5`, `the string "wide"`, `true`, `a list of 2 items`, `nothing`.
std::string describe(const Value& value);

}  // namespace rubble
