// What rubble.options does: reads the table that a function of a script was given by a description
// of its parameters, with the same reader, and so the same words, as a mission's own keys.
//
//   rubble.options("my_mode", given, {
//     { "length", 5, min = 0.5, max = 50, unit = "m", doc = "Length of the slab." },
//     { "debris.layers", 2, type = "integer", min = 0, max = 100, doc = "Layers of debris." },
//   })
//
// A parameter's type follows from its default: a number, true or false, a string (`choices` names
// the ones allowed), {x, y, z}; `type` says it otherwise: "number", "integer", "boolean", "string",
// "strings", "vector", "range" (a number or {min, max}), "table" (taken as it is).
#pragma once

#include <deque>
#include <string>
#include <variant>
#include <vector>

#include "scripting/sandbox/lua_tokens.h"
#include "scripting/schema/schema.h"
#include "scripting/values/value.h"

namespace rubble {

class OptionTable {
 public:
  // Throws InputError (without file and line) for a description that makes no sense.
  explicit OptionTable(const Value& description);
  OptionTable(const OptionTable&) = delete;
  OptionTable& operator=(const OptionTable&) = delete;

  const Schema& schema() const { return schema_; }
  // Takes what was given; nil stands for an empty table. Mistakes have keys "WHERE.PARAMETER".
  std::vector<Diagnostic> read(const std::string& where, const Value& given);
  // Every parameter, given or default, as a table.
  Value values() const;

 private:
  using Storage =
      std::variant<bool, std::int64_t, double, std::optional<double>, std::string,
                   std::optional<std::string>, int, Vec3, std::optional<Vec3>, NumberPair,
                   std::optional<NumberPair>, std::vector<std::string>, Value>;

  void add(const Value& entry, std::size_t number);
  Key& add_key(const std::string& path, const std::string& doc, const Value& entry);

  Schema schema_;
  std::deque<Storage> members_;  // a deque never moves what the schema refers to
};

// Where a call gave a parameter: the line of `key` in a table constructor that follows the name
// `function` in a script, by preference of the call on that line; the call's own line when it
// is nowhere.
int find_option_line(const std::vector<LuaToken>& tokens, const std::string& function,
                     const std::string& key, int call_line);

}  // namespace rubble
