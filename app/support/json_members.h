// Reads JSON that a program of ours wrote and a person may have changed: every step that does not
// find what it expects throws InputError with the file and the path of the member.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "kernel/base/error.h"

namespace rubble {

class JsonMembers {
 public:
  // The JSON must outlive the reader. path: of this value in the file; empty: the whole.
  JsonMembers(const nlohmann::ordered_json& json, std::string file, std::string path = "")
      : json_(json), file_(std::move(file)), path_(std::move(path)) {}

  bool has(const std::string& name) const { return json_.is_object() && json_.contains(name); }
  JsonMembers object(const std::string& name) const;
  std::vector<JsonMembers> list(const std::string& name) const;
  std::vector<std::pair<std::string, JsonMembers>> members() const;  // of this object, in order
  std::string text(const std::string& name) const { return member(name).as_text(); }
  double number(const std::string& name) const { return member(name).as_number(); }
  std::int64_t integer(const std::string& name) const { return member(name).as_integer(); }
  std::uint64_t unsigned_integer(const std::string& name) const;
  bool boolean(const std::string& name) const;

  std::string as_text() const;
  double as_number() const;
  std::int64_t as_integer() const;
  std::string dump() const { return json_.dump(); }

  [[noreturn]] void fail(const std::string& name, const std::string& expected) const;

 private:
  JsonMembers member(const std::string& name) const;
  std::string path_of(const std::string& name) const;
  [[noreturn]] void fail_here(const std::string& expected) const;

  const nlohmann::ordered_json& json_;
  std::string file_, path_;
};

// Throws InputError with the line for text that is not JSON.
nlohmann::ordered_json parse_json_text(const std::string& text, const std::string& file);

}  // namespace rubble
