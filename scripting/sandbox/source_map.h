// Where in a script a key was written. Lua forgets it, so the source text is read a second time.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rubble {

class SourceMap {
 public:
  // entry: the last word of the function that takes the script's table: "mission" or "pack".
  SourceMap(std::string_view text, const std::string& entry);

  // The line of "pile.mix[2].weight" in the table that the script returns: of the key itself if it
  // was written in a table constructor or an assignment (also through a variable: `local p = {...}
  // return rubble.mission { pile = p }`); otherwise of the nearest table around it; otherwise of
  // the call of the entry function, or of the `return`. 0: nothing of that is there.
  int line_of(const std::string& key) const;

  struct Duplicate {
    std::string key;       // whole path of the key
    int line, first_line;  // of the second and of the first; 1-based
  };
  // Keys written twice in one table constructor of the returned table; Lua keeps the last silently.
  const std::vector<Duplicate>& duplicates() const { return duplicates_; }

  // A plain integer written as the value of a key of the returned table.
  std::optional<std::int64_t> literal_of(const std::string& key) const;

 private:
  class Builder;

  std::string resolve(const std::string& path) const;

  std::map<std::string, int> lines_;  // by whole path; the returned table's begin with "$"
  std::map<std::string, std::string> aliases_;  // a path whose value is a variable: that one's path
  std::map<std::string, std::string> literals_;  // a path whose value is a number
  std::vector<Duplicate> duplicates_;
  int root_line_ = 0;
};

}  // namespace rubble
