// What bash and zsh offer when the tabulator is pressed, from the same declarations as --help.
#pragma once

#include <string>
#include <vector>

#include "app/command_line/command.h"

namespace rubble {

// keys: of a mission, which --set offers.
std::string make_bash_completion(const std::vector<CommandDescription>& commands,
                                 const std::vector<std::string>& keys);
std::string make_zsh_completion(const std::vector<CommandDescription>& commands,
                                const std::vector<std::string>& keys);

}  // namespace rubble
