// A resolved scenario as JSON and back, by the schema.
#include <nlohmann/json.hpp>

#include "kernel/base/text.h"
#include "scripting/scenario/mission_form.h"
#include "scripting/schema/schema.h"

namespace rubble {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Value& value) {
  switch (value.kind) {
    case Value::Kind::boolean:
      return value.boolean;
    case Value::Kind::integer:
      return value.integer;
    case Value::Kind::number:
      return value.number;
    case Value::Kind::text:
      return value.text;
    case Value::Kind::table: {
      Json json = value.fields.empty() ? Json::array() : Json::object();
      for (const Value& item : value.items) json.push_back(json_of(item));
      for (const auto& [name, member] : value.fields) json[name] = json_of(member);
      return json;
    }
    default:
      return nullptr;
  }
}

// Lua's empty table is a list or a map; of a key that is a map, it is one.
Json json_of(const Slot& slot) {
  Json json = json_of(read_slot(slot));
  const bool map = std::holds_alternative<TextMap*>(slot) || std::holds_alternative<NumberMap*>(slot);
  return map && json.empty() ? Json::object() : json;
}

Json json_of_group(const Schema& schema, const std::string& pattern, std::size_t index) {
  Json object = Json::object();
  for (const Key* key : schema.children(pattern)) {
    if (key->kind == KeyKind::value) {
      object[key->name()] = json_of(key->bind(index));
    } else if (key->kind == KeyKind::group) {
      object[key->name()] = json_of_group(schema, key->path, index);
    } else {
      Json list = Json::array();
      for (std::size_t i = 0; i < key->size(); ++i)
        list.push_back(json_of_group(schema, key->path + "[]", i));
      object[key->name()] = std::move(list);
    }
  }
  return object;
}

// null means "not set", so such members are left out.
Value value_of(const Json& json) {
  if (json.is_boolean()) return Value::make_boolean(json.get<bool>());
  if (json.is_number_unsigned() && json.get<std::uint64_t>() > std::uint64_t(INT64_MAX))
    return Value::make_number(json.get<double>());
  if (json.is_number_integer()) return Value::make_integer(json.get<std::int64_t>());
  if (json.is_number()) return Value::make_number(json.get<double>());
  if (json.is_string()) return Value::make_text(json.get<std::string>());
  if (json.is_null()) return {};
  Value table = Value::make_table();
  for (const auto& [name, member] : json.items()) {
    if (json.is_array())
      table.items.push_back(value_of(member));
    else if (!member.is_null())
      table.set(name, value_of(member));
  }
  return table;
}

int line_of_byte(const std::string& text, std::size_t byte) {
  int line = 1;
  for (std::size_t i = 0; i < byte && i < text.size(); ++i) line += text[i] == '\n';
  return line;
}

}  // namespace

std::string slot_to_json(const Slot& slot) { return json_of(slot).dump(); }

std::string members_to_json(const Schema& schema) { return json_of_group(schema, "", 0).dump(2); }

Value parse_json(const std::string& text, const std::string& file) {
  if (calc_json_depth(text) > kDeepestJson)
    throw InputError({file, 0, "", "nested too deep", "at most 200 levels of brackets", "", ""});
  try {
    return value_of(Json::parse(text));
  } catch (const Json::out_of_range&) {
    throw InputError({file, 0, "", "a number in it is too large", "", "", ""});
  } catch (const Json::parse_error& error) {
    throw InputError({file, line_of_byte(text, error.byte), "", "not valid JSON", "", "", ""});
  }
}

std::string scenario_to_json(const Scenario& scenario) {
  MissionForm form(scenario);
  return members_to_json(make_scenario_schema(form));
}

Scenario scenario_from_json(const std::string& text, const std::string& file) {
  MissionForm form;
  std::vector<Diagnostic> mistakes;
  const Value value = parse_json(text, file);
  if (value.kind != Value::Kind::table)
    throw InputError({file, 0, "", "not a scenario", "an object", describe(value), ""});
  read_table(make_scenario_schema(form), value, mistakes);
  if (mistakes.empty()) mistakes = find_mistakes(form);
  for (Diagnostic& d : mistakes) d.file = file;
  if (!mistakes.empty()) throw InputError(std::move(mistakes));
  return form.normalized();
}

}  // namespace rubble
