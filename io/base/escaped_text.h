// Text inside files whose format gives some characters a meaning.
#pragma once

#include <string>

#include "kernel/base/text.h"

namespace rubble {

// Text inside a table of comma-separated values (RFC 4180).
// A field: in quotation marks where it has a comma or a quotation mark. Control characters, which would make a row of
// their own or steer a terminal, are written as \x0a.
inline std::string csv_text(const std::string& text) {
  const std::string line = one_line(text);
  if (line.find_first_of(",\"") == std::string::npos) return line;
  std::string quoted = "\"";
  for (const char c : line) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

// Text inside an XML 1.0 document.
// For an attribute or an element. Bytes that XML forbids, and all beyond ASCII of a text that is not UTF-8, become
// question marks.
inline std::string xml_text(const std::string& text) {
  const bool utf8 = find_invalid_utf8(text) == std::string::npos;
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else if (c == '\n')
      out += "&#10;";
    else if ((byte < 0x20 && c != '\t') || byte == 0x7f || (byte > 0x7f && !utf8))
      out += '?';
    else
      out += c;
  }
  return out;
}

}  // namespace rubble
