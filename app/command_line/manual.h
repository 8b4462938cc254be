// Manual pages for man(1), from the same declarations as --help.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "app/command_line/command_description.h"
#include "app/command_line/program_text.h"

namespace rubble {

// The names of its page and of the program's: "rubble-eval-map.1" for "eval map", "rubble.1" for "".
std::string manual_file(const std::string& command);

// In the language of the man(7) macros, without a date: the same text from the same program.
std::string make_manual(const ProgramText& text, const std::vector<CommandDescription>& commands);
std::string make_manual(const ProgramText& text, const CommandDescription& command);

}  // namespace rubble
