// The missions of scripts/, without what is no mission by itself: suites, and what missions include.
#pragma once

#include <filesystem>
#include <set>
#include <string>

namespace rubble::testing {

// Paths relative to `scripts`.
inline std::set<std::string> find_bundled_missions(const std::string& scripts) {
  const std::set<std::string> included{"demonstration_pile", "fifty", "lean_to_pile", "suite"};
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(scripts)) {
    const std::filesystem::path& path = entry.path();
    if (path.extension() != ".lua" || included.count(path.stem().string()) != 0) continue;
    names.insert(path.lexically_relative(scripts).string());
  }
  return names;
}

}  // namespace rubble::testing
