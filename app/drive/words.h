// Short texts with numbers, for the lines of a window.
#pragma once

#include <cstdio>
#include <string>

namespace rubble {

// As printf() makes it; at most 239 characters.
template <typename... Values>
std::string words(const char* format, Values... values) {
  char text[240];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

}  // namespace rubble
