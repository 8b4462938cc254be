// Text inside a table of comma-separated values (RFC 4180).
#pragma once

#include <string>

#include "kernel/base/text.h"

namespace rubble {

// A field: in quotation marks where it has a comma or a quotation mark. Control characters, which would make a row of
// their own or steer a terminal, are written as \x0a.
inline std::string csv_text(const std::string& text) {
  const std::string line = one_line(text);
  if (line.find_first_of(",\"") == std::string::npos) return line;
  std::string quoted = "\"";
  for (const char c : line) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

}  // namespace rubble
