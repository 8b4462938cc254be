#include <cmath>
#include <nlohmann/json.hpp>

#include "scripting/reference/schema_docs.h"
#include "scripting/scenario/mission_form.h"
#include "scripting/schema/schema.h"

namespace rubble {
namespace {

using Json = nlohmann::ordered_json;

Json with_range(Json json, const Range& range) {
  if (std::isfinite(range.min)) json[range.above_min ? "exclusiveMinimum" : "minimum"] = range.min;
  if (std::isfinite(range.max)) json["maximum"] = range.max;
  return json;
}

Json array_of(const Json& item, int count) {
  return {{"type", "array"}, {"items", item}, {"minItems", count}, {"maxItems", count}};
}

Json vector_schema(const Range& range) {
  const Json number = with_range({{"type", "number"}}, range);
  const Json object = {{"type", "object"},
                       {"properties", {{"x", number}, {"y", number}, {"z", number}}},
                       {"required", {"x", "y", "z"}},
                       {"additionalProperties", false}};
  return {{"anyOf", Json::array({array_of(number, 3), object})}};
}

Json pair_schema(const Range& range) {
  const Json number = with_range({{"type", "number"}}, range);
  return {{"anyOf", Json::array({array_of(number, 2), number})}};
}

Json strings_schema() { return {{"type", "array"}, {"items", {{"type", "string"}}}}; }

Json or_null(const Json& json) { return {{"anyOf", Json::array({json, {{"type", "null"}}})}}; }

struct TypeOf {
  const Range& range;

  Json operator()(bool*) const { return {{"type", "boolean"}}; }
  Json operator()(const Negated&) const { return {{"type", "boolean"}}; }
  Json operator()(int*) const { return with_range({{"type", "integer"}}, range); }
  Json operator()(std::int64_t*) const { return with_range({{"type", "integer"}}, range); }
  Json operator()(std::uint64_t*) const { return with_range({{"type", "integer"}}, range); }
  Json operator()(double*) const { return with_range({{"type", "number"}}, range); }
  Json operator()(std::optional<double>*) const {
    return or_null(with_range({{"type", "number"}}, range));
  }
  Json operator()(std::string*) const { return {{"type", "string"}}; }
  Json operator()(std::optional<std::string>*) const { return or_null({{"type", "string"}}); }
  Json operator()(const Choice& choice) const { return {{"enum", choice.names}}; }
  Json operator()(Vec3*) const { return vector_schema(range); }
  Json operator()(std::optional<Vec3>*) const { return or_null(vector_schema(range)); }
  Json operator()(NumberPair*) const { return pair_schema(range); }
  Json operator()(std::optional<NumberPair>*) const { return or_null(pair_schema(range)); }
  Json operator()(std::vector<std::string>*) const { return strings_schema(); }
  Json operator()(const PlaceSlot&) const {
    const Json place = {{"type", "object"},
                        {"properties", {{"find_void", {{"type", "object"}}}}},
                        {"required", {"find_void"}},
                        {"additionalProperties", false}};
    return {{"anyOf", Json::array({vector_schema(range), place, {{"type", "null"}}})}};
  }
  Json operator()(std::vector<double>*) const {
    return {{"type", "array"}, {"items", with_range({{"type", "number"}}, range)}};
  }
  Json operator()(Value*) const { return Json::object(); }
  Json operator()(const StringOrList&) const {
    return {{"anyOf", Json::array({{{"type", "string"}}, strings_schema()})}};
  }
  Json operator()(const TableList&) const {
    return {{"type", "array"}, {"items", {{"type", "object"}}}};
  }
  Json operator()(const NamedTables&) const { return Json::object(); }
  Json operator()(TextMap*) const {
    return {{"type", "object"}, {"additionalProperties", {{"type", "string"}}}};
  }
  Json operator()(NumberMap*) const {
    return {{"type", "object"}, {"additionalProperties", with_range({{"type", "number"}}, range)}};
  }
  Json operator()(const WordOrFile& slot) const {
    const Json file = {{"type", "object"},
                       {"properties", {{slot.key, {{"type", "string"}}}}},
                       {"required", {slot.key}},
                       {"additionalProperties", false}};
    return {{"anyOf", Json::array({{{"enum", slot.words}}, file})}};
  }
};

Json object_schema(const Schema& schema, const std::string& pattern);

Json value_schema(const Key& key) {
  Json json = {{"description", key.doc_text}};
  if (!key.unit_text.empty()) json["description"] = key.doc_text + " unit: " + key.unit_text;
  json.update(std::visit(TypeOf{key.range}, key.bind(0)));
  const Slot slot = key.bind(0);
  if (!key.required) json["default"] = Json::parse(slot_to_json(slot));
  if (const auto* tables = std::get_if<TableList>(&slot)) {
    tables->resize(1);  // so that an item's defaults can be read
    json["items"] = object_schema(tables->make_item(0), "");
  }
  if (const auto* tables = std::get_if<NamedTables>(&slot)) {
    tables->reset({tables->example});
    json.update(or_null({{"type", "object"},
                         {"additionalProperties", object_schema(tables->make_item(0), "")}}));
  }
  return json;
}

Json object_schema(const Schema& schema, const std::string& pattern) {
  Json properties = Json::object(), required = Json::array();
  for (const Key* key : schema.children(pattern)) {
    if (key->required) required.push_back(key->name());
    if (key->kind == KeyKind::value) {
      properties[key->name()] = value_schema(*key);
      continue;
    }
    Json json = {{"description", key->doc_text}};
    if (key->kind == KeyKind::list) {
      key->resize(1);  // so that an item's defaults can be read
      json.update({{"type", "array"}, {"items", object_schema(schema, key->path + "[]")}});
    } else if (const Key* on = schema.find(key->path + ".on"); on && on->parent() == key->path) {
      json["anyOf"] = Json::array({object_schema(schema, key->path), {{"type", "boolean"}}});
    } else {
      json.update(object_schema(schema, key->path));
    }
    properties[key->name()] = std::move(json);
  }
  Json object = {{"type", "object"}, {"properties", properties}, {"additionalProperties", false}};
  if (!required.empty()) object["required"] = required;
  return object;
}

// An alias has the type of the key, or of the number in the vector, that it stands for.
Json alias_schema(const Schema& schema, const Alias& alias) {
  const std::string words =
      "Another name of " + std::string(alias.negated ? "not " : "") + alias.path;
  const Key* key = schema.find(alias.path);
  Json json = {{"description", words}};
  if (key) {
    json.update(std::visit(TypeOf{key->range}, key->bind(0)));
  } else {
    key = schema.find(alias.path.substr(0, alias.path.rfind('.')));
    json.update(with_range({{"type", "number"}}, key->range));
  }
  return json;
}

}  // namespace

std::vector<std::string> mission_keys() {
  MissionForm form;
  const Schema schema = make_scenario_schema(form);
  std::vector<std::string> keys;
  for (const Key& key : schema.keys())
    if (key.kind == KeyKind::value && key.path.find("[]") == std::string::npos)
      keys.push_back(key.path);
  for (const Alias& alias : schema.aliases()) keys.push_back(alias.name);
  return keys;
}

std::string mission_json_schema() {
  MissionForm form;
  const Schema schema = make_scenario_schema(form);
  Json json = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
               {"title", "Rubble mission"}};
  json.update(object_schema(schema, ""));
  for (const Alias& alias : schema.aliases())
    json["properties"][alias.name] = alias_schema(schema, alias);
  return json.dump(2);
}

}  // namespace rubble
