#include "app/command_line/command_reference.h"

#include <map>

namespace rubble {
namespace {

constexpr int kFewest = 3;  // commands with the same option make it a common one

std::string as_code(const std::string& text) { return "`" + text + "`"; }

// A table's "|" ends a cell, and what looks like a tag or a variable is shown as it is.
std::string escape_cell(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '|' || c == '<') out += '\\';
    out += c;
  }
  return out;
}

std::string table_row(const std::string& term, const std::string& text) {
  return "|" + term + "|" + escape_cell(text) + "|\n";
}

std::string markdown_table(const std::string& head, const std::string& rows) {
  return rows.empty() ? "" : "|" + head + "|meaning|\n|---|---|\n" + rows + "\n";
}

// "-h, --help", "--out DIR"
std::string option_term(const OptionDescription& option) {
  std::string names;
  for (const std::string& name : option.names) names += (names.empty() ? "" : ", ") + name;
  return as_code(names + (option.value.empty() || option.by_place ? "" : " " + option.value));
}

std::string option_text(const OptionDescription& option) {
  return option.help + (option.required && !option.by_place ? "; required" : "") + ".";
}

using Rows = std::map<std::string, std::string>;  // of common options, by their names

std::string option_row(const OptionDescription& option) { return table_row(option_term(option), option_text(option)); }

std::string usage_of(const CommandDescription& command) {
  std::string line = "rubble " + command.name;
  for (const OptionDescription& option : command.options) {
    if (!option.by_place) continue;
    const std::string name = option.names.front() + (option.several ? " ..." : "");
    line += " " + (option.required ? name : "[" + name + "]");
  }
  for (const OptionDescription& option : command.options)
    if (!option.by_place && option.required) line += " " + option.names.back() + " " + option.value;
  return as_code(line + " [OPTION] ...");
}

std::string command_section(const CommandDescription& command, const Rows& common_rows) {
  std::string rows, common;
  for (const OptionDescription& option : command.options) {
    const std::string line = option_row(option);
    const auto found = common_rows.find(option.names.back());
    if (found == common_rows.end() || found->second != line)
      rows += line;
    else if (option.names.back() != "--help")
      common += (common.empty() ? "" : ", ") + as_code(option.names.back());
  }
  return "## `rubble " + command.name + "`\n\n" + command.summary + ".\n\n" + usage_of(command) + "\n\n" +
         markdown_table("option", rows) + (common.empty() ? "" : "Common options: " + common + ".\n\n");
}

}  // namespace

std::string make_command_reference(const ProgramText& text, const std::vector<CommandDescription>& commands) {
  std::map<std::string, int> counts;
  Rows common_rows;
  std::string common, codes, variables, sections;
  for (const CommandDescription& command : commands)
    for (const OptionDescription& option : command.options) {
      const std::string line = option_row(option);
      // Of several options with one name, the first that is common.
      if (++counts[line] == kFewest && common_rows.emplace(option.names.back(), line).second) common += line;
    }
  for (const CommandDescription& command : commands) sections += command_section(command, common_rows);
  for (const auto& [number, meaning] : text.exit_codes) codes += table_row(as_code(std::to_string(number)), meaning + ".");
  for (const auto& [name, meaning] : text.environment) variables += table_row(as_code(name), meaning + ".");
  sections.pop_back();
  return "# Commands\n\n" + text.about +
         " `rubble COMMAND --help` prints the options of a command, and `rubble manual COMMAND` its manual page.\n\n"
         "## Exit codes\n\n" + markdown_table("code", codes) + "## Environment\n\n" + markdown_table("variable", variables) +
         "## Common options\n\nThese options have the same meaning in every command that names them.\n\n" +
         markdown_table("option", common) + sections;
}

}  // namespace rubble
