// Values of calibration files by their keys: each refusal names the file and the key.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kernel/base/error.h"
#include "scripting/values/value.h"

namespace rubble {

class CalibrationValues {
 public:
  explicit CalibrationValues(std::string path) : path_(std::move(path)) {}

 protected:
  using KeyNames = std::initializer_list<const char*>;

  [[noreturn]] void refuse(const std::string& key, const std::string& message, const std::string& expected = "",
                           const std::string& found = "", const std::string& hint = "") const {
    throw InputError({path_, 0, "", key.empty() ? message : "`" + key + "`: " + message, expected, found, hint});
  }

  static std::string keys_of(const Value& table) {
    std::string keys;
    for (const auto& [key, value] : table.fields) keys += (keys.empty() ? "" : ", ") + key;
    return keys.substr(0, 200);
  }

  static const Value* find(const Value& table, KeyNames names) {
    for (const char* name : names)
      if (const Value* found = table.find(name)) return found;
    return nullptr;
  }

  double number(const Value* value, const std::string& key) const {
    if (!value || !value->is_number()) refuse(key, "no number", "a number", value ? describe(*value) : "nothing");
    return value->number;
  }

  std::string text(const Value* value, const std::string& key) const {
    if (!value || value->kind != Value::Kind::text) refuse(key, "no text", "a name", value ? describe(*value) : "nothing");
    return value->text;
  }

  // A list, a matrix of OpenCV or ROS (`data`), or a list of lists; rows one after another.
  std::vector<double> numbers(const Value* value, const std::string& key) const {
    if (!value || value->kind != Value::Kind::table) refuse(key, "no numbers", "a list", value ? describe(*value) : "nothing");
    if (const Value* data = value->find("data")) return numbers(data, key + ".data");
    std::vector<double> list;
    for (const Value& item : value->items) {
      if (item.kind == Value::Kind::table) {
        for (const double v : numbers(&item, key)) list.push_back(v);
      } else {
        list.push_back(number(&item, key));
      }
    }
    return list;
  }

  std::vector<double> numbers(const Value* value, const std::string& key, std::size_t count) const {
    const std::vector<double> list = numbers(value, key);
    if (list.size() != count) refuse(key, "another number of values", std::to_string(count), std::to_string(list.size()));
    return list;
  }

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

// YAML and JSON files as plain values. yaml-cpp stays behind it.
// Of the first document: maps and lists are tables, scalars without quotes numbers or booleans where they
// are such. Also takes OpenCV's FileStorage: `%YAML:1.0` and `!!opencv-matrix`. Throws InputError with `path`
// and line for what is no such text, is nested deeper than 50 or holds more than a million values.
Value parse_yaml(std::string_view text, const std::string& path);

// Metadata of Ouster's LiDARs, as keys of a `lidar`.
struct OusterMetadata {
  Value keys;                      // model, columns, rate and the sensor's own beams
  std::vector<std::string> notes;  // what is left out
  std::string kind;                // of the sensor: "lidar"
};

// Keys at the top of the file (firmware 1 and 2), or in sections such as `beam_intrinsics` (firmware 3). Throws
// InputError with `path` and the key.
OusterMetadata read_ouster_metadata(const Value& root, const std::string& path);

}  // namespace rubble
