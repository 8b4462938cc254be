// YAML and JSON files as plain values. yaml-cpp stays behind it.
#pragma once

#include <string>
#include <string_view>

#include "scripting/values/value.h"

namespace rubble {

// Of the first document: maps and lists are tables, scalars without quotes numbers or booleans where they
// are such. Also takes OpenCV's FileStorage: `%YAML:1.0` and `!!opencv-matrix`. Throws InputError with `path`
// and line for what is no such text, is nested deeper than 50 or holds more than a million values.
Value parse_yaml(std::string_view text, const std::string& path);

}  // namespace rubble
