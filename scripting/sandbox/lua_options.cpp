#include "scripting/sandbox/lua_options.h"

#include <algorithm>
#include <array>

#include "scripting/sandbox/lua_tokens.h"

namespace rubble {
namespace {

constexpr std::size_t kMostParameters = 1000;

[[noreturn]] void fail(std::size_t number, const std::string& message) {
  throw InputError({"", 0, "", "rubble.options: entry " + std::to_string(number) + " " + message, "",
                    "", ""});
}

// What an entry may say of its parameter, beside the name and the default.
constexpr std::array<const char*, 7> kLimits{"min", "above", "max", "unit", "type", "choices", "doc"};

std::string text_of(const Value& entry, const char* name) {
  const Value* value = entry.find(name);
  return value ? value->text : "";
}

// What is said of a parameter must have the type that it is read as.
void check_limits(const Value& entry, std::size_t number) {
  const auto expect = [&](const char* name, const char* expected, const auto& fits) {
    const Value* value = entry.find(name);
    if (value && !fits(*value))
      fail(number, "(`" + entry.items[0].text + "`): " + name + " is " + describe(*value) + ", expected " + expected);
  };
  const auto is_text = [](const Value& value) { return value.kind == Value::Kind::text; };
  for (const char* name : {"min", "above", "max"}) expect(name, "a number", [](const Value& value) { return value.is_number(); });
  for (const char* name : {"unit", "type", "doc"}) expect(name, "a string", is_text);
  expect("choices", "a list of strings", [&](const Value& value) {
    return value.kind == Value::Kind::table && value.fields.empty() && !value.items.empty() &&
           std::all_of(value.items.begin(), value.items.end(), is_text);
  });
  const std::string type = text_of(entry, "type");
  if (entry.find("choices") && !type.empty() && type != "choice")
    fail(number, "(`" + entry.items[0].text + "`) has choices and the type " + type + ": leave the type out");
}

std::string type_of(const Value& entry, const Value& fallback) {
  const std::string stated = text_of(entry, "type");
  if (!stated.empty()) return stated;
  if (entry.find("choices")) return "choice";
  switch (fallback.kind) {
    case Value::Kind::boolean:
      return "boolean";
    case Value::Kind::integer:
    case Value::Kind::number:
      return "number";
    case Value::Kind::text:
      return "string";
    case Value::Kind::table:
      return fallback.items.size() == 3 && fallback.items[0].is_number() ? "vector" : "table";
    default:
      return "";
  }
}

std::vector<std::string> choices_of(const Value& entry) {
  std::vector<std::string> names;
  if (const Value* choices = entry.find("choices"))
    for (const Value& choice : choices->items) names.push_back(choice.text);
  return names;
}

}  // namespace

OptionTable::OptionTable(const Value& description) {
  if (description.kind != Value::Kind::table || !description.fields.empty())
    throw InputError({"", 0, "", "rubble.options takes a list of parameters", "", "", ""});
  if (description.items.size() > kMostParameters)
    throw InputError({"", 0, "", "rubble.options takes at most 1000 parameters", "", "", ""});
  for (std::size_t i = 0; i < description.items.size(); ++i) add(description.items[i], i + 1);
}

// Binds a new member of the type that an entry asks for.
Key& OptionTable::add_key(const std::string& path, const std::string& doc, const Value& entry) {
  const Value fallback = entry.items.size() > 1 ? entry.items[1] : Value{};
  const bool maybe = fallback.kind == Value::Kind::nil;
  const std::string type = type_of(entry, fallback);
  const auto member = [&](auto value) -> Key& {
    members_.emplace_back(std::move(value));
    return schema_.value(path, std::get<decltype(value)>(members_.back()), doc);
  };
  if (type == "boolean") return member(false);
  if (type == "integer") return member(std::int64_t(0));
  if (type == "number") return maybe ? member(std::optional<double>()) : member(0.0);
  if (type == "string") return maybe ? member(std::optional<std::string>()) : member(std::string());
  if (type == "vector") return maybe ? member(std::optional<Vec3>()) : member(Vec3());
  if (type == "range") return maybe ? member(std::optional<NumberPair>()) : member(NumberPair());
  if (type == "strings") return member(std::vector<std::string>());
  if (type == "table") return member(Value());
  if (type == "choice") {
    members_.emplace_back(int(0));
    return schema_.choice(path, std::get<int>(members_.back()), choices_of(entry), doc);
  }
  throw InputError({"", 0, "", "has no type: give a default or `type`", "", "", ""});
}

void OptionTable::add(const Value& entry, std::size_t number) {
  if (entry.items.empty() || entry.items[0].kind != Value::Kind::text) fail(number, "has no name");
  const std::string path = entry.items[0].text;
  for (const auto& field : entry.fields)
    if (std::find(kLimits.begin(), kLimits.end(), field.first) == kLimits.end())
      fail(number, "(`" + path + "`) has the unknown key `" + field.first + "`: expected min, above, max, unit, type, choices or doc");
  check_limits(entry, number);
  const std::size_t dot = path.find('.');
  if (dot != std::string::npos && !schema_.find(path.substr(0, dot)))
    schema_.group(path.substr(0, dot), "");
  try {
    Key& key = add_key(path, text_of(entry, "doc"), entry);
    key.unit(text_of(entry, "unit"));
    if (const Value* min = entry.find("min")) key.range.min = min->number;
    if (const Value* above = entry.find("above")) key.above(above->number, key.range.max);
    if (const Value* max = entry.find("max")) key.range.max = max->number;
    if (entry.items.size() > 1)
      if (const auto wrong = write_slot(key, key.bind(0), entry.items[1], path))
        fail(number, "has a default that it does not take: " + wrong->text());
  } catch (const InputError& error) {
    const std::string words = error.diagnostics().front().message;
    if (words.rfind("rubble.options", 0) == 0) throw;
    fail(number, "(`" + path + "`) " + words);
  }
}

std::vector<Diagnostic> OptionTable::read(const std::string& where, const Value& given) {
  std::vector<Diagnostic> mistakes;
  if (given.kind == Value::Kind::nil) return mistakes;
  if (given.kind != Value::Kind::table)
    return {{"", 0, where, "wrong type", "a table", describe(given), "write " + where + "{ ... }"}};
  read_table(schema_, given, mistakes);
  for (Diagnostic& d : mistakes) d.key = d.key.empty() || d.key[0] == '[' ? where + d.key : where + "." + d.key;
  return mistakes;
}

Value OptionTable::values() const {
  Value table = Value::make_table();
  for (const Key& key : schema_.keys()) {
    if (key.kind == KeyKind::group) table.set(key.path, Value::make_table());
    if (key.kind != KeyKind::value) continue;
    const Value value = read_slot(key.bind(0));
    if (value.kind == Value::Kind::nil) continue;
    Value* into = &table;
    for (auto& [name, member] : table.fields)
      if (name == key.parent()) into = &member;
    into->set(key.name(), value);
  }
  return table;
}

namespace {

// The line of the last of `names` inside the table constructor whose `{` is token i; 0: not there.
int find_field(const std::vector<LuaToken>& tokens, std::size_t i,
               const std::vector<std::string>& names) {
  int depth = 0, line = 0;
  std::size_t found = 0;  // names that lead here
  for (; i + 1 < tokens.size(); ++i) {
    const LuaToken& t = tokens[i];
    if (t.is("{") || t.is("(")) ++depth;
    if (t.is("}") || t.is(")")) --depth;
    if (depth == 0) break;
    const bool is_field = t.kind == LuaToken::Kind::name && tokens[i + 1].is("=");
    if (!is_field || found >= names.size() || depth != int(found) + 1 || t.text != names[found])
      continue;
    line = t.line;
    ++found;
  }
  return line;
}

}  // namespace

int find_option_line(const std::vector<LuaToken>& tokens, const std::string& function,
                     const std::string& key, int call_line) {
  const std::string name = function.substr(function.rfind('.') + 1);
  std::vector<std::string> names{""};
  for (const char c : key) {
    if (c == '[') break;
    if (c == '.')
      names.emplace_back();
    else
      names.back() += c;
  }
  int elsewhere = 0;
  for (std::size_t i = 0; i + 2 < tokens.size(); ++i) {
    if (tokens[i].kind != LuaToken::Kind::name || tokens[i].text != name) continue;
    const std::size_t brace = tokens[i + 1].is("(") ? i + 2 : i + 1;
    if (!tokens[brace].is("{")) continue;
    const int line = find_field(tokens, brace, names);
    if (line == 0) continue;
    if (tokens[i].line == call_line || tokens[brace].line == call_line) return line;
    if (elsewhere == 0) elsewhere = line;
  }
  return elsewhere != 0 && call_line == 0 ? elsewhere : call_line;
}

}  // namespace rubble
