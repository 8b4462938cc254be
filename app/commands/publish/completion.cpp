// `rubble completion`: what bash and zsh complete.
#include "app/command_line/completion.h"

#include <memory>

#include "app/command_line/command.h"
#include "app/support/print.h"
#include "scripting/reference/schema_docs.h"

namespace rubble {
namespace {

ExitCode print_completion(const std::string& shell) {
  const auto commands = describe_commands(all_commands());
  if (shell != "bash" && shell != "zsh")
    throw InputError(
        {"", 0, "shell", "no completion for this shell", "bash or zsh", "`" + shell + "`", ""});
  const std::string text = shell == "bash" ? make_bash_completion(commands, mission_keys())
                                           : make_zsh_completion(commands, mission_keys());
  print_out("%s", text.c_str());
  return ExitCode::done;
}

Action declare_completion(CommandLine& line) {
  const auto shell = std::make_shared<std::string>();
  line.add("shell", *shell, "The shell: bash or zsh").required().metavar("SHELL");
  return [shell] { return print_completion(*shell); };
}

}  // namespace

Command completion_command() {
  return {"", "completion",
          "Print a completion script for a shell: commands, options and keys",
          declare_completion};
}

}  // namespace rubble
