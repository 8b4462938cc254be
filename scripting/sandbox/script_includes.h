// The files that a script takes in: found beside it only, checked and kept. Private to scripting.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scripting/sandbox/lua_sandbox.h"

namespace rubble {

class ScriptIncludes {
 public:
  void begin(const std::string& text, const std::string& path) { chunks_.assign(1, {path, text, ""}); }
  // From now on these texts, by path relative to the script, instead of files.
  void serve(std::map<std::string, std::string> texts) { served_ = std::move(texts); }

  // Read the file of that name and return its index among the chunks; on failure they return -1 and `error` has the
  // reason. As in LuaHost.
  int open_text(const std::string& name, std::string& error);
  int open_grid(const std::string& name, int side, std::string& error);

  const std::vector<SourceFile>& chunks() const { return chunks_; }  // 0: the script itself
  const std::vector<SourceFile>& included() const { return included_; }  // each file once, in order of first use

 private:
  std::optional<std::filesystem::path> path_inside(const std::string& name, std::string& error) const;
  std::optional<std::string> read(const std::filesystem::path& relative, std::uintmax_t largest, std::string& error) const;
  int keep(const std::filesystem::path& relative, std::string text);

  std::vector<SourceFile> chunks_, included_;
  std::optional<std::map<std::string, std::string>> served_;
};

}  // namespace rubble
