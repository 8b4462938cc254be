// `rubble manual`: the manual pages of the program, for man(1).
#include <memory>

#include "app/command_line/command.h"
#include "app/command_line/manual.h"
#include "app/support/print.h"
#include "io/base/atomic_file.h"
#include "kernel/base/system/output_files.h"

namespace rubble {
namespace {

struct ManualRequest {
  std::vector<std::string> words;  // of the command: "eval", "map"; empty: the program's own page
  std::string all;                 // --all DIR: every page, as files
  bool markdown = false;           // --markdown: docs/reference/commands.md
};

ExitCode write_all(const std::string& folder) {
  const ProgramText text = program_text();
  const auto commands = describe_commands(all_commands());
  make_output_folder(folder);
  write_text_file(folder + "/" + manual_file(""), make_manual(text, commands));
  for (const CommandDescription& command : commands)
    write_text_file(folder + "/" + manual_file(command.name), make_manual(text, command));
  return ExitCode::done;
}

ExitCode print_page(const std::vector<std::string>& words) {
  const ProgramText text = program_text();
  const auto commands = describe_commands(all_commands());
  std::string name;
  for (const std::string& word : words) name += (name.empty() ? "" : " ") + word;
  if (name.empty()) return print_out("%s", make_manual(text, commands).c_str()), ExitCode::done;
  for (const CommandDescription& command : commands)
    if (command.name == name)
      return print_out("%s", make_manual(text, command).c_str()), ExitCode::done;
  throw InputError({"", 0, "command", "no such command", "one of those that `rubble --help` lists",
                    "`" + name + "`", ""});
}

ExitCode print_reference() {
  print_out("%s", make_command_reference(program_text(), describe_commands(all_commands())).c_str());
  return ExitCode::done;
}

Action declare_manual(CommandLine& line) {
  const auto request = std::make_shared<ManualRequest>();
  line.add("command", request->words, "The command, as in: eval map; without it: the page of the program")
      .metavar("COMMAND");
  line.add("--all", request->all, "Write the pages of all commands into this folder instead")
      .metavar("DIR");
  line.add_flag("--markdown", request->markdown, "Print one page of all commands in Markdown instead");
  return [request] {
    if (request->markdown) return print_reference();
    return request->all.empty() ? print_page(request->words) : write_all(request->all);
  };
}

}  // namespace

Command manual_command() {
  return {"", "manual", "Print a manual page, as in: rubble manual run | man -l -", declare_manual};
}

}  // namespace rubble
