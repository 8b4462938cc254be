#include "io/robot/urdf_lines.h"

#include <algorithm>
#include <cctype>

namespace rubble {
namespace {

// The value of an attribute within a tag; empty: it has none.
std::string attribute(const std::string& tag, const std::string& name) {
  for (std::size_t at = tag.find(name); at != std::string::npos; at = tag.find(name, at + 1)) {
    std::size_t next = at + name.size();
    if (at == 0 || std::isspace(static_cast<unsigned char>(tag[at - 1])) == 0) continue;
    while (next < tag.size() && std::isspace(static_cast<unsigned char>(tag[next])) != 0) ++next;
    if (next >= tag.size() || tag[next] != '=') continue;
    const std::size_t open = tag.find_first_of("\"'", next);
    if (open == std::string::npos) return "";
    const std::size_t close = tag.find(tag[open], open + 1);
    return close == std::string::npos ? "" : tag.substr(open + 1, close - open - 1);
  }
  return "";
}

}  // namespace

UrdfLines::UrdfLines(const std::string& text) {
  int line = 1;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\n') ++line;
    if (text[i] != '<') continue;
    const bool comment = text.compare(i, 4, "<!--") == 0;
    const std::size_t end = comment ? text.find("-->", i) : text.find('>', i);
    if (end == std::string::npos) return;
    if (!comment) note(text.substr(i + 1, end - i - 1), line);
    line += int(std::count(text.begin() + std::ptrdiff_t(i), text.begin() + std::ptrdiff_t(end), '\n'));
    i = end;
  }
}

void UrdfLines::note(const std::string& tag, int line) {
  const std::string element = tag.substr(0, tag.find_first_of(" \t\r\n/"));
  if (element.empty()) return;  // the end of one
  elements_[element].push_back(line);
  const std::string name = attribute(tag, "name");
  if (!name.empty()) named_[{element, name}].push_back(line);
}

int UrdfLines::line_of(const std::string& element, const std::string& name) const {
  const auto at = named_.find({element, name});
  return at == named_.end() ? 0 : at->second.front();
}

std::vector<int> UrdfLines::lines_of(const std::string& element) const {
  const auto at = elements_.find(element);
  return at == elements_.end() ? std::vector<int>() : at->second;
}

std::vector<std::string> UrdfLines::doubled(const std::string& element) const {
  std::vector<std::string> names;
  for (const auto& [key, lines] : named_)
    if (key.first == element && lines.size() > 1) names.push_back(key.second);
  return names;
}

}  // namespace rubble
