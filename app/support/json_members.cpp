#include "app/support/json_members.h"

#include <algorithm>
#include <cstdint>

#include "kernel/base/text.h"

namespace rubble {

using Json = nlohmann::ordered_json;

std::string JsonMembers::path_of(const std::string& name) const {
  return path_.empty() ? name : path_ + "." + name;
}

void JsonMembers::fail(const std::string& name, const std::string& expected) const {
  const bool there = has(name);
  throw InputError({file_, 0, path_of(name), there ? "wrong value" : "missing", expected,
                    there ? json_.at(name).dump().substr(0, 60) : "", ""});
}

void JsonMembers::fail_here(const std::string& expected) const {
  throw InputError({file_, 0, path_, "wrong value", expected, json_.dump().substr(0, 60), ""});
}

JsonMembers JsonMembers::member(const std::string& name) const {
  if (!has(name)) fail(name, "a value");
  return {json_.at(name), file_, path_of(name)};
}

JsonMembers JsonMembers::object(const std::string& name) const {
  if (!has(name) || !json_.at(name).is_object()) fail(name, "an object");
  return member(name);
}

std::vector<JsonMembers> JsonMembers::list(const std::string& name) const {
  if (!has(name) || !json_.at(name).is_array()) fail(name, "a list");
  std::vector<JsonMembers> items;
  for (const Json& item : json_.at(name))
    items.push_back({item, file_, path_of(name) + "[" + std::to_string(items.size() + 1) + "]"});
  return items;
}

std::vector<std::pair<std::string, JsonMembers>> JsonMembers::members() const {
  if (!json_.is_object()) fail_here("an object");
  std::vector<std::pair<std::string, JsonMembers>> all;
  for (const auto& [name, value] : json_.items())
    all.emplace_back(name, JsonMembers(value, file_, path_of(name)));
  return all;
}

std::uint64_t JsonMembers::unsigned_integer(const std::string& name) const {
  if (!has(name) || !json_.at(name).is_number_unsigned()) fail(name, "a whole number, 0 or more");
  return json_.at(name).get<std::uint64_t>();
}

bool JsonMembers::boolean(const std::string& name) const {
  if (!has(name) || !json_.at(name).is_boolean()) fail(name, "true or false");
  return json_.at(name).get<bool>();
}

std::string JsonMembers::as_text() const {
  if (!json_.is_string()) fail_here("a text");
  return json_.get<std::string>();
}

double JsonMembers::as_number() const {
  if (!json_.is_number()) fail_here("a number");
  return json_.get<double>();
}

std::int64_t JsonMembers::as_integer() const {
  const bool too_large = json_.is_number_unsigned() &&
                         json_.get<std::uint64_t>() > std::uint64_t(INT64_MAX);
  if (!json_.is_number_integer() || too_large) fail_here("a whole number");
  return json_.get<std::int64_t>();
}

Json parse_json_text(const std::string& text, const std::string& file) {
  if (calc_json_depth(text) > kDeepestJson)
    throw InputError({file, 0, "", "nested too deep", "at most 200 levels of brackets",
                      std::to_string(calc_json_depth(text)), "it was altered"});
  try {
    return Json::parse(text);
  } catch (const Json::out_of_range&) {
    throw InputError({file, 0, "", "a number in it is too large", "", "", "it was altered"});
  } catch (const Json::parse_error& error) {
    const auto end = text.begin() + std::ptrdiff_t(std::min(error.byte, text.size()));
    const int line = 1 + int(std::count(text.begin(), end, '\n'));
    throw InputError({file, line, "", "not valid JSON", "", "", "it was cut short or altered"});
  }
}

}  // namespace rubble
