// The tags of an XML document one after the other, for formats of few elements. No namespaces are resolved, no entities
// but the five of XML and numbers, and text between tags is passed over.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace rubble {

class XmlScanner {
 public:
  explicit XmlScanner(std::string_view xml) : rest_(xml), all_(xml) {}

  // The next tag; false: the end, or a tag that is not closed.
  bool next();

  const std::string_view& name() const { return name_; }  // with its prefix: "m:colorgroup"
  bool closes() const { return closes_; }                 // </name>
  bool is_empty() const { return empty_; }                // <name/>
  // Of the tag; empty: none.
  std::string attribute(std::string_view name) const;
  const std::vector<std::pair<std::string_view, std::string_view>>& attributes() const { return attributes_; }
  int line() const;  // of the tag; 1-based

 private:
  void read_attributes(std::string_view tag);

  std::string_view rest_, all_, name_;
  std::size_t at_ = 0;  // of the tag
  std::vector<std::pair<std::string_view, std::string_view>> attributes_;
  bool closes_ = false, empty_ = false;
};

// Where markup that begins at `at` ends, quotes heeded: a tag, comment, CDATA or declaration.
std::size_t end_of_markup(std::string_view xml, std::size_t at);

}  // namespace rubble
