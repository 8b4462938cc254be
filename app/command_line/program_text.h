// What is said of the program as a whole, in --help and in its manual.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace rubble {

struct ProgramText {
  std::string about;    // a paragraph
  std::string version;  // "rubble 0.1.0"
  std::vector<std::pair<int, std::string>> exit_codes;                  // with their meaning
  std::vector<std::pair<std::string, std::string>> environment;         // variables, likewise
};
ProgramText program_text();

// What follows the list of commands in --help.
std::string make_footer(const ProgramText& text);

}  // namespace rubble
