// What the program says of itself: pages for man(1) and docs/reference/commands.md, from the same declarations as --help.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "app/command_line/command.h"

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

// Manual pages for man(1).

// The names of its page and of the program's: "rubble-eval-map.1" for "eval map", "rubble.1" for "".
std::string manual_file(const std::string& command);

// In the language of the man(7) macros, without a date: the same text from the same program.
std::string make_manual(const ProgramText& text, const std::vector<CommandDescription>& commands);
std::string make_manual(const ProgramText& text, const CommandDescription& command);

// A page of all commands in Markdown, docs/reference/commands.md.
// Options that several commands share come once, in a table of their own; a command then only names them.
std::string make_command_reference(const ProgramText& text, const std::vector<CommandDescription>& commands);

}  // namespace rubble
