// A subcommand of `rubble`. docs/development/contributing.md says how to add one: its file, and its name in
// RUBBLE_COMMANDS of app/CMakeLists.txt, which makes the list.
#pragma once

#include <vector>

#include "app/command_line/command_line.h"

namespace rubble {

struct Command {
  const char* group;    // of `rubble eval map`: "eval"; "": none
  const char* name;     // "map"
  const char* summary;  // a line of the list that --help prints, without its full stop
  Action (*declare)(CommandLine& line);
};

// All of them, in the order of RUBBLE_COMMANDS, which is that of --help.
std::vector<Command> all_commands();

}  // namespace rubble
