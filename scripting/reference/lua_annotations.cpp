#include <algorithm>

#include "scripting/packs/pack_schema.h"
#include "scripting/reference/schema_docs.h"
#include "scripting/reference/slot_types.h"
#include "scripting/sandbox/lua_options.h"
#include "scripting/sandbox/lua_sandbox.h"
#include "scripting/scenario/mission_form.h"

namespace rubble {
namespace {

// "rubble.mission" and "pile.mix[]": "rubble.mission.pile.mix".
std::string class_name(const std::string& root, std::string path) {
  path.erase(std::remove(path.begin(), path.end(), '['), path.end());
  path.erase(std::remove(path.begin(), path.end(), ']'), path.end());
  return path.empty() ? root : root + "." + path;
}

// What a person reads beside a field: its meaning, what it takes, and what it is without being given.
std::string words_about(const Key& key) {
  std::string text = key.doc_text;
  if (key.kind != KeyKind::value) return text;
  text += " Takes " + describe_expected(key) + (key.unit_text.empty() ? "" : ", " + key.unit_text);
  const std::string value = lua_text(read_slot(key.bind(0)));
  text += key.required ? "; must be given." : value.empty() ? "." : "; default " + value + ".";
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

// The class of a group or of a list's item, after the classes of what is in it.
std::string class_of(const Schema& schema, const std::string& pattern, const std::string& root,
                     const std::string& name, const std::string& doc) {
  std::string inner, fields;
  for (const Key* key : schema.children(pattern)) {
    const std::string own = class_name(root, key->path);
    std::string type;
    if (key->kind == KeyKind::value) {
      const Slot slot = key->bind(0);
      type = slot_type(slot).lua;
      if (const auto* tables = std::get_if<TableList>(&slot)) {
        tables->resize(1);  // so that an item's defaults can be read
        inner += class_of(tables->make_item(0), "", own, own, key->doc_text);
        type = own + "[]";
      }
      if (const auto* tables = std::get_if<NamedTables>(&slot)) {
        tables->reset({tables->example});
        inner += class_of(tables->make_item(0), "", own, own, key->doc_text);
        tables->reset({});
        type = "table<string, " + own + ">";
      }
    } else {
      const bool is_list = key->kind == KeyKind::list;
      if (is_list) key->resize(1);
      inner += class_of(schema, is_list ? key->path + "[]" : key->path, root, own, key->doc_text);
      type = is_list ? own + "[]" : own;
      if (!is_list && schema.find(key->path + ".on")) type += "|boolean";  // the switch alone
    }
    fields += "---@field " + key->name() + (key->required ? "" : "?") + " " + type + " " +
              words_about(*key) + "\n";
  }
  return inner + "\n---" + doc + "\n---@class " + name + "\n" + fields;
}

std::string published_names(const Schema& schema) {
  std::string fields;
  for (const Alias& alias : schema.aliases())
    fields += "---@field " + alias.name + "? any Another name of " +
              (alias.negated ? "not " : "") + alias.path + ".\n";
  return fields;
}

std::string result_of(const std::string& function) {
  if (function.rfind("rubble.collapse.", 0) == 0) return "rubble.mission.pile";
  if (function.rfind("rubble.trajectory.", 0) == 0) return "rubble.mission.trajectory";
  if (function == "rubble.slab" || function == "rubble.wall") return "rubble.mission.pile.placed";
  if (function == "rubble.find_void")
    return "{approach: table, entrance: table, deepest: table, widest: table}";
  return "table";
}

// What a function takes before its options.
std::string first_parameter(const std::string& function) {
  if (function == "rubble.density.from" || function == "rubble.terrain.from")
    return "---@param f fun(x: number, y: number): number\n";
  if (function == "rubble.trajectory.along")
    return "---@param f fun(t: number): rubble.Vector|table, rubble.Vector?\n";
  if (function == "rubble.trajectory.join") return "---@param f table[]\n";
  return "";
}

std::string annotate(const DescribedFunction& function) {
  OptionTable table(function.description);
  const std::string options = function.name + ".Options", first = first_parameter(function.name);
  return class_of(table.schema(), "", options, options, "Options of `" + function.name + "`.") +
         "\n" + first + "---@param options? " + options + "\n---@return " +
         result_of(function.name) + "\nfunction " + function.name +
         (first.empty() ? "(options) end\n" : "(f, options) end\n");
}

}  // namespace

std::string lua_annotations() {
  MissionForm form;
  const Schema mission = make_scenario_schema(form);
  PackTable pack_table;
  const Schema pack = make_pack_schema(pack_table);
  std::string text =
      "---@meta rubble\n-- Made by `rubble check --annotations`: for editors, never run.\n";
  text += kLuaBaseAnnotations;
  text += class_of(mission, "", "rubble.mission", "rubble.Mission", "A mission.") +
          published_names(mission);
  text += class_of(pack, "", "rubble.pack", "rubble.Pack", "What pack.lua returns.");
  for (const DescribedFunction& function : LuaSandbox::describe_library())
    if (function.name != "rubble.terrain.image" && function.name != "rubble.density.image")
      text += annotate(function);
  return text;
}

}  // namespace rubble
