#include "app/command_line/command_reference.h"

#include <map>

namespace rubble {
namespace {

constexpr int kFewest = 3;  // commands with the same option make it a common one

std::string code(const std::string& text) { return "`" + text + "`"; }

// A table's "|" ends a cell, and what looks like a tag or a variable is shown as it is.
std::string cell(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '|' || c == '<') out += '\\';
    out += c;
  }
  return out;
}

std::string row(const std::string& term, const std::string& text) {
  return "|" + term + "|" + cell(text) + "|\n";
}

std::string table(const std::string& head, const std::string& rows) {
  return rows.empty() ? "" : "|" + head + "|meaning|\n|---|---|\n" + rows + "\n";
}

// "-h, --help", "--out DIR"
std::string term_of(const OptionDescription& option) {
  std::string names;
  for (const std::string& name : option.names) names += (names.empty() ? "" : ", ") + name;
  return code(names + (option.value.empty() || option.by_place ? "" : " " + option.value));
}

std::string text_of(const OptionDescription& option) {
  return option.help + (option.required && !option.by_place ? "; required" : "") + ".";
}

using Counts = std::map<std::string, int>;  // of rows with the same term and text

std::string row_of(const OptionDescription& option) { return row(term_of(option), text_of(option)); }

std::string synopsis(const CommandDescription& command) {
  std::string line = "rubble " + command.name;
  for (const OptionDescription& option : command.options) {
    if (!option.by_place) continue;
    const std::string name = option.names.front() + (option.several ? " ..." : "");
    line += " " + (option.required ? name : "[" + name + "]");
  }
  for (const OptionDescription& option : command.options)
    if (!option.by_place && option.required) line += " " + option.names.back() + " " + option.value;
  return code(line + " [OPTION] ...");
}

std::string section(const CommandDescription& command, const Counts& counts) {
  std::string rows, common;
  for (const OptionDescription& option : command.options) {
    const std::string line = row_of(option);
    if (counts.at(line) < kFewest)
      rows += line;
    else if (option.names.back() != "--help")
      common += (common.empty() ? "" : ", ") + code(option.names.back());
  }
  return "## `rubble " + command.name + "`\n\n" + command.summary + ".\n\n" + synopsis(command) + "\n\n" +
         table("option", rows) + (common.empty() ? "" : "Common options: " + common + ".\n\n");
}

}  // namespace

std::string make_command_reference(const ProgramText& text, const std::vector<CommandDescription>& commands) {
  Counts counts;
  std::string common, codes, variables, sections;
  for (const CommandDescription& command : commands)
    for (const OptionDescription& option : command.options) {
      const std::string line = row_of(option);
      if (++counts[line] == kFewest) common += line;
    }
  for (const CommandDescription& command : commands) sections += section(command, counts);
  for (const auto& [number, meaning] : text.exit_codes) codes += row(code(std::to_string(number)), meaning + ".");
  for (const auto& [name, meaning] : text.environment) variables += row(code(name), meaning + ".");
  sections.pop_back();
  return "# Commands\n\n" + text.about +
         " `rubble COMMAND --help` prints the options of a command, and `rubble manual COMMAND` its manual page.\n\n"
         "## Exit codes\n\n" + table("code", codes) + "## Environment\n\n" + table("variable", variables) +
         "## Common options\n\nThese options have the same meaning in every command that names them.\n\n" +
         table("option", common) + sections;
}

}  // namespace rubble
