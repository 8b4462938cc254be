// A page of all commands in Markdown, docs/reference/commands.md, from the same declarations as --help.
#pragma once

#include <string>
#include <vector>

#include "app/command_line/command_description.h"
#include "app/command_line/program_text.h"

namespace rubble {

// Options that several commands share come once, in a table of their own; a command then only names them.
std::string make_command_reference(const ProgramText& text, const std::vector<CommandDescription>& commands);

}  // namespace rubble
