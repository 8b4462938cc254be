#include "app/command_line/manual.h"

#include <algorithm>
#include <cctype>

namespace rubble {
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

}  // namespace rubble
