// An XML document as a tree of elements with their lines, read by Expat.
//
// All names and texts come out as UTF-8, whatever the file's encoding is. Entities that a file defines are
// expanded within Expat's own limits; external ones are refused: nothing but the file itself is read.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace rubble {

struct XmlElement {
  std::string name;  // with its prefix: "xacro:include"
  int line = 0;      // where it begins, from 1
  std::vector<std::pair<std::string, std::string>> attributes;  // in the file's order
  std::vector<XmlElement> children;
  std::string text;  // all of its own, without that of its children

  // The attribute's value; null: there is none.
  const std::string* find(const std::string& attribute) const;
  // The first child of that name; null: there is none.
  const XmlElement* child(const std::string& child_name) const;
};

struct XmlDocument {
  XmlElement root;
  std::vector<std::string> warnings;  // with file and line: how a doubtful encoding was read
};

// text: the bytes of the whole file. path: for messages. Throws InputError with file and line for what is not
// well-formed, has more than one root or an encoding that is not known, or is nested deeper than 200 elements.
// Common mistakes are forgiven, as other readers do: blanks before `<?xml`, "--" within a comment, zero bytes at the end.
XmlDocument parse_xml(const std::string& text, const std::string& path);

}  // namespace rubble
