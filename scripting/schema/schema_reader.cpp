// From a user's table, or a --set argument, to the members that a schema binds.
#include <algorithm>
#include <charconv>
#include <system_error>

#include "kernel/base/tables/text_table.h"
#include "kernel/base/text.h"
#include "scripting/schema/override_text.h"
#include "scripting/schema/schema.h"

namespace rubble {
namespace {

// More help nobody, and a hostile script could name a million keys.
constexpr std::size_t kMostMistakes = 1000;

std::string joined(const std::string& path, const std::string& name) {
  return path.empty() || name[0] == '[' ? path + name : path + "." + name;
}

std::string list_names(const std::vector<std::string>& names) {
  std::string text = "one of ";
  for (std::size_t i = 0; i < names.size(); ++i) text += (i ? ", " : "") + names[i];
  return text;
}

Diagnostic unknown_key(const std::string& shown_path, const std::string& name,
                       const std::vector<std::string>& names,
                       const std::vector<std::string>& more_names) {
  Diagnostic d;
  d.key = shown_path;
  d.message = "unknown key `" + name + "`";
  std::vector<std::string> candidates = names;
  candidates.insert(candidates.end(), more_names.begin(), more_names.end());
  const std::string near = nearest_name(name, candidates);
  if (near.empty())
    d.expected = list_names(names);
  else
    d.hint = "did you mean `" + near + "`?";
  return d;
}

std::vector<std::string> names_of(const std::vector<const Key*>& keys) {
  std::vector<std::string> names;
  for (const Key* key : keys) names.push_back(key->name());
  return names;
}

std::vector<std::string> alias_names(const Schema& schema) {
  std::vector<std::string> names;
  for (const Alias& alias : schema.aliases()) names.push_back(alias.name);
  return names;
}

// A key with the member it means here: an item of a list, a component of a vector, or both.
struct Target {
  Key key;  // a component's has the vector's range
  Slot slot;
};

// The key by which a group is switched on, where it has one: `imu = true` is `imu = { on = true }`.
const Key* find_switch(const Schema& schema, const Key& group) {
  return group.kind == KeyKind::group ? schema.find(group.path + ".on") : nullptr;
}

std::optional<Target> component_of(const Target& whole, const std::string& name) {
  if (name.size() != 1 || name[0] < 'x' || name[0] > 'z') return std::nullopt;
  Vec3* vector = nullptr;
  if (auto* const* plain = std::get_if<Vec3*>(&whole.slot)) vector = *plain;
  if (auto* const* maybe = std::get_if<std::optional<Vec3>*>(&whole.slot); maybe && **maybe)
    vector = &***maybe;
  if (const auto* place = std::get_if<PlaceSlot>(&whole.slot); place && !*place->in_void) {
    if (place->point) vector = place->point;
    if (place->maybe && *place->maybe) vector = &**place->maybe;
  }
  if (!vector) return std::nullopt;
  return Target{whole.key, Slot(&(*vector)[name[0] - 'x'])};
}

// "pile.mix[2].weight" -> "pile.mix[].weight" and 1. False when an index is not a number above 0.
bool split_index(const std::string& path, std::string& pattern, std::size_t& index) {
  const std::size_t open = path.find('[');
  pattern = path;
  index = 0;
  if (open == std::string::npos) return true;
  const std::size_t close = path.find(']', open);
  if (close == std::string::npos) return false;
  const auto result = std::from_chars(path.data() + open + 1, path.data() + close, index);
  if (result.ec != std::errc() || result.ptr != path.data() + close || index == 0) return false;
  pattern = path.substr(0, open) + "[]" + path.substr(close + 1);
  --index;
  return true;
}

std::optional<Target> find_target(const Schema& schema, const std::string& path);

// "cameras.front.width": a key of a named table, in that table's own schema.
std::optional<Target> find_in_named_table(const Schema& schema, const std::string& path) {
  const std::size_t dot = path.find('.');
  const std::size_t end = dot == std::string::npos ? dot : path.find('.', dot + 1);
  if (end == std::string::npos) return std::nullopt;
  const Key* key = schema.find(path.substr(0, dot));
  if (!key || key->kind != KeyKind::value) return std::nullopt;
  const Slot slot = key->bind(0);
  const auto* tables = std::get_if<NamedTables>(&slot);
  if (!tables) return std::nullopt;
  const std::vector<std::string> names = tables->names();
  const auto at = std::find(names.begin(), names.end(), path.substr(dot + 1, end - dot - 1));
  if (at == names.end()) return std::nullopt;
  return find_target(tables->make_item(std::size_t(at - names.begin())), path.substr(end + 1));
}

std::optional<Target> find_target(const Schema& schema, const std::string& path) {
  if (auto found = find_in_named_table(schema, path)) return found;
  std::string pattern;
  std::size_t index = 0;
  if (!split_index(path, pattern, index)) return std::nullopt;
  const std::size_t item = pattern.find("[]");
  if (item != std::string::npos) {
    const Key* list = schema.find(pattern.substr(0, item));
    if (!list || list->kind != KeyKind::list || index >= list->size()) return std::nullopt;
  }
  const Key* key = schema.find(pattern);
  if (key && key->kind == KeyKind::group) key = find_switch(schema, *key);
  if (key)
    return key->kind == KeyKind::value ? std::optional(Target{*key, key->bind(index)})
                                       : std::nullopt;
  if (schema.find(pattern)) return std::nullopt;
  const std::size_t dot = pattern.rfind('.');
  if (dot == std::string::npos) return std::nullopt;
  const Key* whole = schema.find(pattern.substr(0, dot));
  if (!whole || whole->kind != KeyKind::value) return std::nullopt;
  return component_of({*whole, whole->bind(index)}, pattern.substr(dot + 1));
}

std::optional<Target> alias_target(const Schema& schema, const Alias& alias) {
  std::optional<Target> target = find_target(schema, alias.path);
  if (target && alias.negated) target->slot = Negated{std::get<bool*>(target->slot)};
  return target;
}

const Alias* find_alias(const Schema& schema, const std::string& name) {
  for (const Alias& alias : schema.aliases())
    if (alias.name == name) return &alias;
  return nullptr;
}

class TableReader {
 public:
  TableReader(const Schema& schema, std::vector<Diagnostic>& mistakes, std::vector<std::string>& written)
      : schema_(schema), mistakes_(mistakes), written_(written) {}

  void read_group(const std::string& pattern, const std::string& shown, std::size_t index,
                  const Value& table) {
    const std::vector<const Key*> keys = schema_.children(pattern);
    check_plain_keys(shown, table);
    for (const auto& [name, value] : table.fields) {
      if (mistakes_.size() >= kMostMistakes) return;
      const auto at = std::find_if(keys.begin(), keys.end(),
                                   [&n = name](const Key* key) { return key->name() == n; });
      if (at != keys.end())
        read_key(**at, joined(shown, name), index, value);
      else if (!pattern.empty() || !find_alias(schema_, name))
        mistakes_.push_back(
            unknown_key(joined(shown, name), name, names_of(keys),
                        pattern.empty() ? alias_names(schema_) : std::vector<std::string>{}));
    }
    for (const Key* key : keys)
      if (key->required && !table.find(key->name())) report_missing(*key, shown);
    if (pattern.empty()) read_aliases(table);
  }

 private:
  void check_plain_keys(const std::string& shown, const Value& table) {
    for (const std::string& words : table.strange_keys)
      mistakes_.push_back({"", 0, shown, "unknown key", "named fields", words, ""});
    if (!table.items.empty())
      mistakes_.push_back({"", 0, joined(shown, "[1]"), "a value without a name", "named fields",
                           describe(table.items[0]), "write `name = value`"});
  }

  void report_missing(const Key& key, const std::string& shown) {
    mistakes_.push_back(
        {"", 0, joined(shown, key.name()), "missing", describe_expected(key), "nothing", ""});
  }

  void read_key(const Key& key, const std::string& shown, std::size_t index, const Value& value) {
    if (key.kind == KeyKind::value) {
      const Slot slot = key.bind(index);
      if (const auto* tables = std::get_if<TableList>(&slot)) {
        return read_tables(key, *tables, shown, value);
      }
      if (const auto* tables = std::get_if<NamedTables>(&slot)) {
        return read_named_tables(key, *tables, shown, value);
      }
      written_.push_back(shown);
      if (auto mistake = write_slot(key, key.bind(index), value, shown))
        mistakes_.push_back(*mistake);
    } else if (const Key* on = find_switch(schema_, key); on && value.kind == Value::Kind::boolean) {
      read_key(*on, joined(shown, "on"), index, value);
    } else if (value.kind != Value::Kind::table) {
      mistakes_.push_back(
          {"", 0, shown, "wrong type", describe_expected(key), describe(value), ""});
    } else if (key.kind == KeyKind::group) {
      if (key.implies_on && !value.find("on"))
        read_key(*find_switch(schema_, key), joined(shown, "on"), index, Value::make_boolean(true));
      read_group(key.path, shown, index, value);
    } else {
      read_list(key, shown, value);
    }
  }

  void read_tables(const Key& key, const TableList& tables, const std::string& shown,
                   const Value& value) {
    if (value.kind != Value::Kind::table || !value.fields.empty() || !value.strange_keys.empty()) {
      mistakes_.push_back({"", 0, shown, "wrong type", describe_expected(key), describe(value),
                           "write {{...}, {...}}"});
      return;
    }
    tables.resize(value.items.size());
    for (std::size_t i = 0; i < value.items.size(); ++i) {
      const std::string item = shown + "[" + std::to_string(i + 1) + "]";
      const Schema schema = tables.make_item(i);
      if (value.items[i].kind == Value::Kind::table)
        TableReader(schema, mistakes_, written_).read_group("", item, 0, value.items[i]);
      else
        mistakes_.push_back({"", 0, item, "wrong type", "a table", describe(value.items[i]), ""});
    }
  }

  void read_named_tables(const Key& key, const NamedTables& tables, const std::string& shown,
                         const Value& value) {
    if (value.kind != Value::Kind::table || !value.items.empty() || !value.strange_keys.empty()) {
      mistakes_.push_back({"", 0, shown, "wrong type", describe_expected(key), describe(value),
                           "write { " + tables.example + " = { ... } }"});
      return;
    }
    std::vector<std::string> names;
    for (const auto& field : value.fields) names.push_back(field.first);
    std::sort(names.begin(), names.end());
    tables.reset(names);
    for (std::size_t i = 0; i < names.size(); ++i) {
      const Value& table = *value.find(names[i]);
      const std::string item = joined(shown, names[i]);
      const Schema schema = tables.make_item(i);
      if (table.kind == Value::Kind::table)
        TableReader(schema, mistakes_, written_).read_group("", item, 0, table);
      else
        mistakes_.push_back({"", 0, item, "wrong type", "a table", describe(table), ""});
    }
  }

  void read_list(const Key& key, const std::string& shown, const Value& value) {
    if (!value.fields.empty() || !value.strange_keys.empty()) {
      mistakes_.push_back({"", 0, shown, "wrong type", describe_expected(key), describe(value),
                           "write {{...}, {...}}"});
      return;
    }
    key.resize(value.items.size());
    for (std::size_t i = 0; i < value.items.size(); ++i) {
      const std::string item = shown + "[" + std::to_string(i + 1) + "]";
      if (value.items[i].kind == Value::Kind::table)
        read_group(key.path + "[]", item, i, value.items[i]);
      else
        mistakes_.push_back({"", 0, item, "wrong type", "a table", describe(value.items[i]), ""});
    }
  }

  void read_aliases(const Value& table) {
    for (const Alias& alias : schema_.aliases()) {
      const Value* value = table.find(alias.name);
      if (!value) continue;
      for (const std::string& path : written_)
        if (path == alias.path || alias.path.rfind(path + ".", 0) == 0)
          mistakes_.push_back({"", 0, alias.name, "given twice", "", "",
                               "it is another name of `" + path + "`: keep one of them"});
      const Target target = alias_target(schema_, alias).value();
      if (auto mistake = write_slot(target.key, target.slot, *value, alias.name))
        mistakes_.push_back(*mistake);
    }
  }

  const Schema& schema_;
  std::vector<Diagnostic>& mistakes_;
  std::vector<std::string>& written_;
};

// For a name that is right up to the index of a list's item, or that means more than one value.
std::optional<Diagnostic> half_known_override(const Schema& schema, const std::string& name) {
  std::string pattern;
  std::size_t index = 0;
  if (!split_index(name, pattern, index)) return std::nullopt;
  const Key* key = schema.find(pattern);
  if (key && key->kind != KeyKind::value)
    return Diagnostic{"", 0, name, "not a single value", "a script for lists and tables", "", ""};
  if (!key || pattern == name) return std::nullopt;
  const std::size_t size = schema.find(pattern.substr(0, pattern.find("[]")))->size();
  return Diagnostic{"", 0, name, "no such item: the list has " + std::to_string(size), "", "", ""};
}

// As --set has it: an item of a list has its number, that of the name as far as there is one.
std::string numbered(std::string path, const std::string& name) {
  const std::size_t from = name.find_first_of("123456789");
  const std::string number =
      from == std::string::npos ? "1" : name.substr(from, name.find_first_not_of("0123456789", from) - from);
  for (std::size_t at = path.find("[]"); at != std::string::npos; at = path.find("[]", at)) path.insert(at + 1, number);
  return path;
}

Diagnostic unknown_override(const Schema& schema, const std::string& name) {
  if (const auto half_known = half_known_override(schema, name)) return *half_known;
  std::vector<std::string> paths;
  for (const Key& key : schema.keys())
    if (key.kind == KeyKind::value) paths.push_back(key.path);
  Diagnostic d;
  d.key = name;
  d.message = "unknown key `" + name + "`";
  std::vector<std::string> all = paths;
  for (const Alias& alias : schema.aliases()) all.push_back(alias.name);
  std::string near = nearest_name(name, all);
  if (near.empty())  // the right word without its section is the usual mistake
    for (const std::string& path : paths)
      if (near.empty() && path.size() > name.size() &&
          path.compare(path.size() - name.size() - 1, std::string::npos, "." + name) == 0)
        near = path;
  d.hint = near.empty() ? "`rubble check` prints every key" : "did you mean `" + numbered(near, name) + "`?";
  return d;
}

}  // namespace

void read_table(const Schema& schema, const Value& table, std::vector<Diagnostic>& mistakes, std::vector<std::string>* written) {
  std::vector<std::string> paths;
  TableReader(schema, mistakes, written ? *written : paths).read_group("", "", 0, table);
}

std::string override_path(const Schema& schema, const std::string& text) {
  const std::string name(trimmed(std::string_view(text).substr(0, text.find('='))));
  if (const Alias* alias = find_alias(schema, name)) return alias->path;
  const std::optional<Target> target = find_target(schema, name);
  const bool is_switch = target && target->key.name() == "on" && name.substr(name.rfind('.') + 1) != "on";
  return is_switch ? name + ".on" : name;
}

bool is_within(const std::string& path, const std::string& whole) {
  if (path.compare(0, whole.size(), whole) != 0) return false;
  return path.size() == whole.size() || path[whole.size()] == '.' || path[whole.size()] == '[';
}

void apply_override(const Schema& schema, const std::string& text,
                    std::vector<Diagnostic>& mistakes) {
  const std::size_t equals = text.find('=');
  Diagnostic mistake;
  if (find_invalid_utf8(text) != std::string_view::npos) {
    mistake = {"", 0, "", "is not UTF-8 text", "UTF-8", "\"" + text + "\"", ""};
  } else if (equals == std::string::npos || equals == 0) {
    mistake = {"", 0, "", "not an assignment", "KEY=VALUE", "\"" + text + "\"", ""};
  } else {
    const std::string name(trimmed(std::string_view(text).substr(0, equals)));
    const Alias* alias = find_alias(schema, name);
    const std::optional<Target> target =
        alias ? alias_target(schema, *alias) : find_target(schema, name);
    if (!target) {
      mistake = unknown_override(schema, name);
    } else {
      const Value value = parse_override(target->slot, std::string(trimmed(std::string_view(text).substr(equals + 1))));
      const auto failed = write_slot(target->key, target->slot, value, name);
      if (!failed) return;
      mistake = *failed;
    }
  }
  mistake.file = "--set";
  mistakes.push_back(mistake);
}

std::vector<Diagnostic> check_ranges(const Schema& schema) {
  std::vector<Diagnostic> mistakes;
  for (const Key& key : schema.keys()) {
    if (key.kind != KeyKind::value) continue;
    const std::size_t item = key.path.find("[]");
    const std::size_t count =
        item == std::string::npos ? 1 : schema.find(key.path.substr(0, item))->size();
    for (std::size_t i = 0; i < count; ++i) {
      std::string shown = key.path;
      if (item != std::string::npos) shown.insert(item + 1, std::to_string(i + 1));
      const Slot slot = key.bind(i);
      if (const auto* tables = std::get_if<TableList>(&slot)) {
        for (std::size_t k = 0; k < tables->size(); ++k)
          for (Diagnostic& d : check_ranges(tables->make_item(k))) {
            d.key = shown + "[" + std::to_string(k + 1) + "]." + d.key;
            mistakes.push_back(std::move(d));
          }
        continue;
      }
      if (const auto* tables = std::get_if<NamedTables>(&slot)) {
        const std::vector<std::string> names = tables->names();
        for (std::size_t k = 0; k < names.size(); ++k)
          for (Diagnostic& d : check_ranges(tables->make_item(k))) {
            d.key = shown + "." + names[k] + "." + d.key;
            mistakes.push_back(std::move(d));
          }
        continue;
      }
      const Value value = read_slot(slot);
      if (value.kind == Value::Kind::nil) continue;
      if (auto mistake = write_slot(key, slot, value, shown)) mistakes.push_back(*mistake);
    }
  }
  return mistakes;
}

}  // namespace rubble
