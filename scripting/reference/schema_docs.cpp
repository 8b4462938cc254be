#include "scripting/reference/schema_docs.h"

#include <algorithm>
#include <cctype>
#include <stdexcept>

#include "scripting/packs/pack_schema.h"
#include "scripting/reference/lua_text.h"
#include "scripting/sandbox/lua_library.h"
#include "scripting/sandbox/lua_options.h"
#include "scripting/sandbox/lua_sandbox.h"
#include "scripting/scenario/scenario_schema.h"

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

std::string row(const Key& key, const std::string& name) {
  const std::string value =
      key.required ? "must be given" : as_code(lua_text(read_slot(key.bind(0))));
  return "| `" + name + "` | " + cell(describe_expected(key)) + " | " + key.unit_text +
         " | " + cell(value) + " | " + cell(key.doc_text) + " |\n";
}

constexpr const char* kHead =
    "| key | takes | unit | default | meaning |\n| --- | --- | --- | --- | --- |\n";

// The keys of a named table that are not those of a group or a key of the mission itself.
std::string named_section(const Schema& mission, const Schema& item, const Key& of) {
  std::string rows;
  for (const Key* key : item.children(""))
    if (key->kind == KeyKind::value && !mission.find("camera." + key->path))
      rows += row(*key, key->name());
  return "### `" + of.path + "`, tables by name\n\n" + of.doc_text + "\n\n" + kHead + rows + "\n";
}

// One heading and table for a group, then one for each group or list in it.
std::string section(const Schema& schema, const std::string& pattern, const std::string& heading,
                    const std::string& doc) {
  std::string rows, below;
  for (const Key* key : schema.children(pattern)) {
    if (key->kind == KeyKind::value) {
      rows += row(*key, key->name());
      const Slot slot = key->bind(0);
      if (const auto* tables = std::get_if<TableList>(&slot)) {
        tables->resize(1);
        below += section(tables->make_item(0), "", "`" + key->path + "`, a list of tables",
                         key->doc_text);
      }
      if (const auto* tables = std::get_if<NamedTables>(&slot)) {
        tables->reset({tables->example});
        below += named_section(schema, tables->make_item(0), *key);
      }
      continue;
    }
    const bool is_list = key->kind == KeyKind::list;
    if (is_list) key->resize(1);  // so that an item's defaults can be read
    below += section(schema, is_list ? key->path + "[]" : key->path,
                     "`" + key->path + "`" + (is_list ? ", a list of tables" : ""), key->doc_text);
  }
  std::string text = heading.empty() ? "" : "### " + heading + "\n\n" + doc + "\n\n";
  if (!rows.empty()) text += kHead + rows + "\n";
  return text + below;
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

// The rows of the parameters that are, or are not, among `names`.
std::string option_rows(const DescribedFunction& function, const Names& names, bool among) {
  OptionTable table(function.description);
  std::string rows;
  for (const Key& key : table.schema().keys())
    if (key.kind == KeyKind::value && has(names, key.path) == among) rows += row(key, key.path);
  return rows.empty() ? "" : kHead + rows + "\n";
}

std::string comment_of(const std::string& file_name) {
  for (const LibraryFile& file : lua_library())
    if (file.name == file_name) return leading_comment(file.text);
  return "";
}

std::string function_section(const DescribedFunction& function, const Names& common) {
  std::string file = function.name.substr(function.name.find('.') + 1);
  std::replace(file.begin(), file.end(), '.', '/');
  return "### `" + function.name + "`\n\n" + comment_of(file) + "\n\n" +
         option_rows(function, common, false);
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
      "## Collapse modes\n\n" +
      folder_sections("collapse", "debris.layers",
                      "Common parameters of all modes except `heap`") +
      "## Densities\n\nHorizontal distributions of pieces, for `pile.spawn_density`. "
      "`rubble.density.image(file)` takes a picture of the script's folder: white pixels get the "
      "most pieces, and the upper edge is at +Y.\n\n" +
      folder_sections("density", "", "") +
      "## Terrain\n\nTerrain on the ground, for `pile.terrain`. `rubble.terrain.image(file, { length = 40, "
      "amplitude = 2 })` takes a picture or an elevation model of the script's folder "
      "([formats.md](formats.md#elevation-models)): black is 0, white is `amplitude`, heights in metres keep their "
      "scale, and the upper edge is at +Y. `samples` (default 256, at most 900) limits the points a side, `missing` is "
      "the height of points without one, `smooth` averages neighbours. The other options are those of "
      "`rubble.terrain.from`. "
      "A mesh is given as `pile.terrain = { file = \"site.obj\" }`.\n\n" +
      folder_sections("terrain", "", "") + "## Paths\n\n" +
      folder_sections("trajectory", "rate_hz", "Common parameters of all paths");
  text += "## Robots\n\nEach gives an entry of `robots` ([robots.md](robots.md)). `control` may be a function.\n\n" +
          folder_sections("robot", "name", "Common parameters of all robots");
  for (const DescribedFunction& function : LuaSandbox::describe_library())
    if (function.name == "rubble.find_void")
      text += "## Places in voids\n\n" + function_section(function, {});
  return text;
}

std::string alias_table(const Schema& schema) {
  std::string text =
      "### Names of the published simulator\n\nThe parameters of the published Unity simulator "
      "under its names, at the top level of a mission and in `--set`. The axes are those of Rubble: Z is up.\n\n"
      "| name | stands for |\n| --- | --- |\n";
  for (const Alias& alias : schema.aliases())
    text +=
        "| `" + alias.name + "` | " + (alias.negated ? "not " : "") + "`" + alias.path + "` |\n";
  return text + "\n";
}

}  // namespace

std::string lua_reference() {
  Scenario scenario;
  const Schema mission = make_scenario_schema(scenario);
  PackTable pack_table;
  const Schema pack = make_pack_schema(pack_table);
  return "\n## Keys of a mission\n\n" + section(mission, "", "", "") + alias_table(mission) +
         library_reference() + "## Keys of pack.lua\n\n" + section(pack, "", "", "");
}

std::string with_reference(const std::string& document) {
  const std::size_t begin = document.find(kBegin), end = document.find(kEnd);
  if (begin == std::string::npos || end == std::string::npos || end < begin)
    throw std::runtime_error("the document lacks the lines that mark the reference");
  return document.substr(0, begin) + kBegin + lua_reference() + document.substr(end);
}

}  // namespace rubble
