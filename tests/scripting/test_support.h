// What the tests of scripting share.
#pragma once

#include <functional>
#include <string>

#include "kernel/base/error.h"
#include "scripting/mission.h"

namespace rubble {

// The whole text of the InputError that `action` throws; "" when it throws none.
inline std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

inline Mission load_text(const std::string& text, const MissionOptions& options = {}) {
  return load_mission_text(text, "m.lua", options);
}

inline std::string mission_error(const std::string& text, const MissionOptions& options = {}) {
  return error_of([&] { load_text(text, options); });
}

inline MissionOptions with_overrides(std::vector<std::string> overrides) {
  MissionOptions options;
  options.overrides = std::move(overrides);
  return options;
}

}  // namespace rubble
