// Where things stand in a URDF file: liburdfdom keeps no lines.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace rubble {

class UrdfLines {
 public:
  // text: of the whole file.
  explicit UrdfLines(const std::string& text);

  // Of the first <element ... name="NAME">; 0: there is none.
  int line_of(const std::string& element, const std::string& name) const;
  // Of every element of that name.
  std::vector<int> lines_of(const std::string& element) const;
  // Names that two elements of that kind have.
  std::vector<std::string> doubled(const std::string& element) const;

 private:
  void note(const std::string& tag, int line);

  std::map<std::pair<std::string, std::string>, std::vector<int>> named_;
  std::map<std::string, std::vector<int>> elements_;
};

}  // namespace rubble
