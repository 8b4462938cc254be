// A subcommand of `rubble`. docs/development/contributing.md says how to add one: its file, and its name in
// RUBBLE_COMMANDS of app/CMakeLists.txt, which makes the list.
#pragma once

#include <string>
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

// The commands and their options as data, from the declarations that the parser works by: the manual
// and the completion of shells are made from it and cannot drift apart from what is accepted.
struct OptionDescription {
  std::vector<std::string> names;  // "--out"; of an argument by place its name: "mission"
  std::string value;               // what stands for its value, "DIR"; empty: it takes none
  std::string help;                // with its default
  bool by_place = false;           // an argument without a name in front
  bool required = false;           // the command is refused without it
  bool several = false;            // may be given more than once
};

struct CommandDescription {
  std::string name;     // as typed after `rubble`: "run", "eval map"
  std::string summary;  // without a full stop
  std::vector<OptionDescription> options;  // arguments by place first
};

// In the order of --help.
std::vector<CommandDescription> describe_commands(const std::vector<Command>& commands);

}  // namespace rubble
