#include "scripting/reference/schema_docs.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>

#include "kernel/base/number_text.h"
#include "scripting/packs/pack_schema.h"
#include "scripting/reference/slot_types.h"
#include "scripting/sandbox/lua_library.h"
#include "scripting/sandbox/lua_options.h"
#include "scripting/sandbox/lua_sandbox.h"
#include "scripting/scenario/mission_form.h"

namespace rubble {

std::string lua_text(const Value& value) {
  if (value.kind == Value::Kind::nil) return "";
  if (value.kind == Value::Kind::text) return value.text.empty() ? "" : "\"" + value.text + "\"";
  if (value.kind != Value::Kind::table) return describe(value);
  std::string text = "{";
  for (const Value& item : value.items) text += (text.size() > 1 ? ", " : "") + lua_text(item);
  return text + "}";
}

namespace {

constexpr const char* kBegin = "<!-- reference: begin -->\n";
constexpr const char* kEnd = "<!-- reference: end -->\n";

std::string as_code(const std::string& text) { return text.empty() ? "" : "`" + text + "`"; }

// A table's "|" ends a cell.
std::string cell(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2)
    text.insert(at, "\\");
  return text;
}

// Texts name pages as the tree does: "docs/reference/robots.md". The reference links to them.
std::string linked(const std::string& text) {
  static const std::string kFolder = "docs/", kEnding = ".md";
  std::string out;
  std::size_t from = 0;
  for (std::size_t at; (at = text.find(kFolder, from)) != std::string::npos;) {
    const std::size_t end = text.find(kEnding, at), slash = text.rfind('/', end);
    if (end == std::string::npos) break;
    const std::string page = text.substr(slash + 1, end + kEnding.size() - slash - 1);
    const std::string folder = text.substr(at + kFolder.size(), slash + 1 - at - kFolder.size());
    out += text.substr(from, at - from) + "[" + page + "](" + (folder == "reference/" ? "" : "../" + folder) + page + ")";
    from = end + kEnding.size();
  }
  return out + text.substr(from);
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + as_code(name);
  return text;
}

// "1e6" instead of "1e+06".
std::string short_number(double value) {
  std::string text = exact_text(value);
  const std::size_t at = text.find('e');
  if (at != std::string::npos && text[at + 1] == '+') text.erase(at + 1, 1);
  if (at != std::string::npos) {
    const std::size_t zero = at + 1 + (text[at + 1] == '-');
    if (text[zero] == '0') text.erase(zero, 1);
  }
  return text;
}

// "0..10", ">0..10", ">=0"
std::string short_range(const Range& range) {
  const bool low = std::isfinite(range.min), high = std::isfinite(range.max);
  if (!low && !high) return "";
  if (!high) return (range.above_min ? ">" : ">=") + short_number(range.min);
  return (low ? (range.above_min ? ">" : "") + short_number(range.min) : "") + ".." + short_number(range.max);
}

std::string allowed(const Key& key) {
  const Slot slot = key.bind(0);
  if (const auto* choice = std::get_if<Choice>(&slot)) return listed(choice->names);
  if (const auto* words = std::get_if<WordOrFile>(&slot))
    return listed(words->words) + ", `{ " + words->key + " = \"FILE\" }`";
  return short_range(key.range);
}

std::string row(const Key& key, const std::string& name) {
  const std::string value = key.required ? "required" : as_code(lua_text(read_slot(key.bind(0))));
  const std::string type = slot_type(key.bind(0)).word;
  return "|`" + name + "`|" + type + (key.unit_text.empty() ? "" : ", " + key.unit_text) + "|" +
         cell(allowed(key)) + "|" + cell(value) + "|" + cell(linked(key.doc_text)) + "|\n";
}

constexpr const char* kHead = "|key|type, unit|range|default|meaning|\n|---|---|---|---|---|\n";

std::string table_of_rows(const std::string& rows) { return rows.empty() ? "" : kHead + rows + "\n"; }

std::string heading_of(const std::string& path, const std::string& form, const std::string& doc) {
  return "### `" + path + "`\n\n" + form + linked(doc) + "\n\n";
}

// The keys of a named table that `one`, the group for a single one, does not have: "cameras" and "camera".
std::string named_section(const Schema& mission, const Schema& item, const Key& of) {
  const std::string one = of.path.substr(0, of.path.size() - 1) + ".";
  std::string rows;
  for (const Key* key : item.children(""))
    if (key->kind == KeyKind::value && !mission.find(one + key->path)) rows += row(*key, key->name());
  for (const Key& key : item.keys())
    if (key.parent() == "ride" && !mission.find(one + key.path)) rows += row(key, key.path);
  return heading_of(of.path, "Tables by name. ", of.doc_text) + table_of_rows(rows);
}

// A kind of sensor: what all kinds have the same is in the table of the first.
std::string sensor_section(const Schema& item, const Schema& first, const Key& of) {
  std::string rows;
  for (const Key& key : item.keys()) {
    if (key.kind != KeyKind::value) continue;
    const Key* const same = first.find(key.path);
    if (!same || row(*same, key.path) != row(key, key.path)) rows += row(key, key.path);
  }
  return heading_of(of.path, "Tables by name. ", of.doc_text) + table_of_rows(rows);
}

bool is_sensor(const std::string& key) {
  const auto& kinds = sensor_kinds();
  return std::any_of(kinds.begin(), kinds.end(), [&](const SensorKind* kind) { return kind->key() == key; });
}

// One table for the keys of a group, then one for each group or list in it.
std::string section(const Schema& schema, const std::string& pattern, const std::string& heading) {
  std::string rows, below;
  for (const Key* key : schema.children(pattern)) {
    if (key->kind == KeyKind::value) {
      const Slot slot = key->bind(0);
      if (const auto* tables = std::get_if<TableList>(&slot)) {
        tables->resize(1);
        below += section(tables->make_item(0), "", heading_of(key->path, "List of tables. ", key->doc_text));
      } else if (const auto* named = std::get_if<NamedTables>(&slot)) {
        named->reset({named->example});
        const std::string first = sensor_kinds().front()->key();
        if (is_sensor(key->path) && key->path != first) {
          const Slot others = schema.find(first)->bind(0);
          below += sensor_section(named->make_item(0), std::get<NamedTables>(others).make_item(0), *key);
        } else {
          below += named_section(schema, named->make_item(0), *key);
        }
      } else {
        rows += row(*key, key->name());
      }
      continue;
    }
    const bool is_list = key->kind == KeyKind::list;
    if (is_list) key->resize(1);  // so that an item's defaults can be read
    below += section(schema, is_list ? key->path + "[]" : key->path,
                     heading_of(key->path, is_list ? "List of tables. " : "", key->doc_text));
  }
  return heading + table_of_rows(rows) + below;
}

// The comment that a library file begins with, as text: "rubble.collapse.heap: nothing ..." without
// the name.
std::string leading_comment(const std::string& text) {
  std::string words;
  for (std::size_t at = 0; text.compare(at, 2, "--") == 0;) {
    const std::size_t end = text.find('\n', at);
    const std::size_t from = std::min(end, at + 3);
    if (from == end)
      words += "\n\n";
    else
      words += (words.empty() || words.back() == '\n' ? "" : " ") + text.substr(from, end - from);
    at = end + 1;
  }
  const std::size_t colon = words.find(": ");
  words = words.substr(colon + 2);
  words[0] = char(std::toupper(static_cast<unsigned char>(words[0])));
  return words;
}

using Names = std::vector<std::string>;

bool has(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

Names parameters_of(const DescribedFunction& function) {
  OptionTable table(function.description);
  Names names;
  for (const Key& key : table.schema().keys())
    if (key.kind == KeyKind::value) names.push_back(key.path);
  return names;
}

// "robots" of "As `robots.name`.", where the parameter itself is called name; otherwise "".
std::string table_it_follows(const Key& key) {
  const std::string begin = "As `", end = "." + key.path + "`.";
  const std::string& doc = key.doc_text;
  if (doc.rfind(begin, 0) != 0 || doc.size() <= begin.size() + end.size()) return "";
  if (doc.compare(doc.size() - end.size(), end.size(), end) != 0) return "";
  return doc.substr(begin.size(), doc.size() - begin.size() - end.size());
}

// The parameters that are, or are not, among `names`. Those that are a key of the mission are only named.
std::string option_rows(const DescribedFunction& function, const Names& names, bool among) {
  OptionTable table(function.description);
  std::string rows, table_name;
  Names same;
  for (const Key& key : table.schema().keys()) {
    if (key.kind != KeyKind::value || has(names, key.path) != among) continue;
    const std::string follows = table_it_follows(key);
    if (follows.empty()) {
      rows += row(key, key.path);
      continue;
    }
    same.push_back(key.path);
    table_name = follows;
  }
  const std::string as = same.empty() ? "" : "As keys of `" + table_name + "`: " + listed(same) + ".\n\n";
  return as + table_of_rows(rows);
}

std::string comment_of(const std::string& file_name) {
  for (const LibraryFile& file : lua_library())
    if (file.name == file_name) return leading_comment(file.text);
  return "";
}

std::string function_section(const DescribedFunction& function, const Names& common) {
  std::string file = function.name.substr(function.name.find('.') + 1);
  std::replace(file.begin(), file.end(), '.', '/');
  const bool is_mode = file.rfind("collapse/", 0) == 0;
  const std::string picture = is_mode ? "![](../pictures/" + file + ".png)\n\n" : "";
  return heading_of(function.name, "", comment_of(file)) + picture + option_rows(function, common, false);
}

// Every function of a folder; what all those that have `marker` share comes once, at the end.
std::string folder_sections(const std::string& folder, const std::string& marker,
                            const std::string& heading) {
  std::vector<DescribedFunction> functions;
  for (DescribedFunction& function : LuaSandbox::describe_library())
    if (function.name.rfind("rubble." + folder + ".", 0) == 0)
      functions.push_back(std::move(function));
  Names common;
  const DescribedFunction* sample = nullptr;
  for (const DescribedFunction& function : functions) {
    const Names names = parameters_of(function);
    if (!has(names, marker)) continue;
    Names shared;
    for (const std::string& name : names)
      if (!sample || has(common, name)) shared.push_back(name);
    common = shared, sample = &function;
  }
  std::string text;
  for (const DescribedFunction& function : functions)
    text += function_section(function, has(parameters_of(function), marker) ? common : Names{});
  if (sample) text += "### " + heading + "\n\n" + option_rows(*sample, common, true);
  return text;
}

std::string library_reference() {
  std::string text =
      "## Collapse modes\n\nEach mode gives a `pile`: fixed stubs of walls and heavy slabs that settle, then debris that falls on them. The "
      "pictures are sections; red is the cut.\n\n" +
      folder_sections("collapse", "debris.layers", "Common parameters of all modes except `heap`") +
      "## Densities\n\nHorizontal distributions of pieces, for `pile.spawn_density`.\n\n### `rubble.density.image`\n\n" +
      comment_of("density/image") + "\n\n" + folder_sections("density", "", "") +
      "## Terrain\n\nTerrain on the ground, for `pile.terrain`. A mesh is given as `pile.terrain = { file = \"site.obj\" }`.\n\n" +
      folder_sections("terrain", "", "") + "### `rubble.terrain.image`\n\n" + comment_of("terrain/image") +
      " `length` is the length along X, `samples` (default 256, at most 900) limits the points a side, `missing` is the "
      "height of points without one, and `smooth` counts how often neighbours are averaged (" +
      linked("docs/reference/formats.md") + "). `x`, `y`, `friction` and `look` are those of `rubble.terrain.from`.\n\n## Paths\n\nEach gives a `trajectory`.\n\n" +
      folder_sections("trajectory", "rate_hz", "Common parameters of all paths");
  text += "## Robots\n\nModels give an entry of `robots`. The others are controllers: functions for `control` (" +
          linked("docs/reference/robots.md") + ").\n\n" +
          folder_sections("robot", "name", "Common parameters of all robots");
  for (const DescribedFunction& function : LuaSandbox::describe_library())
    if (function.name == "rubble.find_void")
      text += "## Places in voids\n\n" + function_section(function, {});
  return text;
}

std::string alias_table(const Schema& schema) {
  std::string text =
      "### Names of the published simulator\n\nThe parameters of the published Unity simulator keep their names, "
      "at the top level of a mission and in `--set`. The axes are those of Rubble: Z is up.\n\n"
      "|name|stands for|\n|---|---|\n";
  for (const Alias& alias : schema.aliases())
    text += "|`" + alias.name + "`|" + (alias.negated ? "not " : "") + "`" + alias.path + "`|\n";
  return text + "\n";
}

}  // namespace

std::string lua_reference() {
  MissionForm form;
  const Schema mission = make_scenario_schema(form);
  PackTable pack_table;
  const Schema pack = make_pack_schema(pack_table);
  return "\n## Keys of a mission\n\n" + section(mission, "", "") + alias_table(mission) + library_reference() +
         "## Keys of pack.lua\n\n" + section(pack, "", "");
}

std::string with_reference(const std::string& document) {
  const std::size_t begin = document.find(kBegin), end = document.find(kEnd);
  if (begin == std::string::npos || end == std::string::npos || end < begin)
    throw std::runtime_error("the document lacks the lines that mark the reference");
  return document.substr(0, begin) + kBegin + lua_reference() + document.substr(end);
}

}  // namespace rubble
