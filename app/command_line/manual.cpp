#include "app/command_line/manual.h"

#include <algorithm>
#include <cctype>
#include <map>

#include "app/support/build_info.h"

namespace rubble {

ProgramText program_text() {
  ProgramText text;
  text.about =
      "Rubble simulates collapsed structures, and robots with sensors in them. A mission in Lua and a seed give a "
      "settled ruin, recordings for ROS, MRPT and other tools, and the ground truth.";
  text.version = "rubble " + build_info().version;
  text.exit_codes = {{0, "done"},    {1, "bad input"},
                     {2, "failure"}, {3, "finished, but the pile did not settle or lost pieces"},
                     {4, "stopped by a signal"}, {5, "results or files differ or are missing"}};
  text.environment = {
      {"RUBBLE_ASSETS", "Folder of the bundled packs; default: `assets` beside the program, or "
                        "`../share/rubble/assets`"},
      {"RUBBLE_THREADS", "Number of threads without --threads; default: one per processor"},
      {"RUBBLE_CACHE", "Folder of the cache; default: ~/.cache/rubble; `off`: no cache"},
      {"RUBBLE_DEVICE", "What draws without --device: `software`, `gl` or `gl:N`; default: the key `device` of the mission"}};
  return text;
}

std::string make_footer(const ProgramText& text) {
  std::string codes;
  for (const auto& [code, meaning] : text.exit_codes)
    codes += (codes.empty() ? "" : ", ") + std::to_string(code) + " " + meaning;
  std::string footer = "Exit codes: " + codes + ".\n\nEnvironment:";
  for (const auto& [name, meaning] : text.environment) footer += "\n  " + name + ": " + meaning;
  return footer;
}

namespace {

// Text as it is to be read. A minus is one that can be copied, and a line must not begin like a macro.
std::string escape(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const bool begins = out.empty() || out.back() == '\n';
    if (begins && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
  }
  return out;
}

std::string bold(const std::string& text) { return "\\fB" + escape(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + escape(text) + "\\fR"; }

std::string page_name(const std::string& command) {
  std::string name = "rubble" + std::string(command.empty() ? "" : "-") + command;
  std::replace(name.begin(), name.end(), ' ', '-');
  return name;
}

std::string sentence(const std::string& text) {
  return text + (text.empty() || text.back() == '.' ? "" : ".");
}

std::string title(const ProgramText& text, const std::string& command) {
  std::string name = page_name(command);
  for (char& c : name) c = char(std::toupper(static_cast<unsigned char>(c)));
  return ".TH " + escape(name) + " 1 \"\" \"" + escape(text.version) + "\" \"User Commands\"\n";
}

std::string section(const std::string& name, const std::string& text) {
  return ".SH " + name + "\n" + text + (text.empty() || text.back() == '\n' ? "" : "\n");
}

// A term and what is said of it.
std::string item(const std::string& term, const std::string& text) {
  return ".TP\n" + term + "\n" + escape(sentence(text)) + "\n";
}

std::string synopsis(const CommandDescription& command) {
  std::string line = bold("rubble " + command.name);
  for (const OptionDescription& option : command.options) {
    if (!option.by_place) continue;
    const std::string name = italic(option.names.front()) + (option.several ? " ..." : "");
    line += " " + (option.required ? name : "[" + name + "]");
  }
  for (const OptionDescription& option : command.options)
    if (!option.by_place && option.required)
      line += " " + bold(option.names.back()) + " " + italic(option.value);
  return line + " [" + italic("OPTION") + "] ...";
}

std::string term_of(const OptionDescription& option) {
  if (option.by_place) return italic(option.names.front());
  std::string names;
  for (const std::string& name : option.names) names += (names.empty() ? "" : ", ") + bold(name);
  return option.value.empty() ? names : names + " " + italic(option.value);
}

std::string exit_codes(const ProgramText& text) {
  std::string items;
  for (const auto& [code, meaning] : text.exit_codes) items += item(bold(std::to_string(code)), meaning);
  return section("EXIT STATUS", items);
}

std::string environment(const ProgramText& text) {
  std::string items;
  for (const auto& [name, meaning] : text.environment) items += item(bold(name), meaning);
  return section("ENVIRONMENT", items);
}

}  // namespace

std::string manual_file(const std::string& command) { return page_name(command) + ".1"; }

std::string make_manual(const ProgramText& text, const std::vector<CommandDescription>& commands) {
  std::string list, pages;
  for (const CommandDescription& command : commands) {
    list += item(bold("rubble " + command.name), command.summary);
    pages += (pages.empty() ? "" : ",\n") + bold(page_name(command.name)) + "(1)";
  }
  return title(text, "") + section("NAME", "rubble \\- simulate collapsed structures for robots") +
         section("SYNOPSIS", bold("rubble") + " " + italic("COMMAND") + " [" + italic("OPTION") +
                                 "] ...") +
         section("DESCRIPTION", escape(text.about)) + section("COMMANDS", list) +
         environment(text) + exit_codes(text) + section("SEE ALSO", pages);
}

std::string make_manual(const ProgramText& text, const CommandDescription& command) {
  std::string options;
  for (const OptionDescription& option : command.options)
    options += item(term_of(option), option.help);
  return title(text, command.name) +
         section("NAME", escape(page_name(command.name) + " ") + "\\- " + escape(command.summary)) +
         section("SYNOPSIS", synopsis(command)) +
         section("DESCRIPTION", escape(sentence(command.summary))) + section("OPTIONS", options) +
         environment(text) + exit_codes(text) + section("SEE ALSO", bold("rubble") + "(1)");
}

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
