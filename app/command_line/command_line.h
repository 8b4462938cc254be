// The command line as a command declares it: every option is bound to the member that it fills, and
// its help can state that member's value as the default. CLI11 stays behind command_line.cpp: it
// costs five seconds in each unit that sees it.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "kernel/base/error.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace rubble {

// What is done with a command's request, once the parser has filled it. Returns the exit code or
// throws InputError, RunError or Stopped.
using Action = std::function<ExitCode()>;

// One option, while it is declared. Of real numbers only finite ones are taken. Each call returns the option itself.
class Option {
 public:
  Option(CLI::Option& option, std::string value);

  Option& metavar(const std::string& name);  // what stands for its value: "METRES"
  // The help ends in "(default: VALUE)": what the member held when the option was added, then `unit`.
  Option& shows_default(const std::string& unit = "");
  // The same where no value of the member is the default: "out/<name of the script>".
  Option& shows_default_text(const std::string& text);
  Option& required();
  Option& between(int least, int most);        // both may be given; of an integer
  Option& within(double least, double most);   // both may be given; of a number
  Option& positive();
  Option& non_negative();
  Option& separated_by(char delimiter);        // several values in one: "stl,ply"
  Option& needs(const Option& other);
  Option& needs_one_of(const Option& a, const Option& b);
  Option& excludes(const Option& other);

 private:
  CLI::Option* option_;
  std::string value_;  // of the member, as text
};

// What is wrong with the text of an option, as "expected ..., found ..."; empty: nothing, and it was
// taken.
using ReadOption = std::function<std::string(const std::string& text)>;

// The options of one command. `name`: "--size" for an option, "mission" for an argument by place.
// Members must outlive the parsing.
class CommandLine {
 public:
  explicit CommandLine(CLI::App& command) : command_(&command) {}

  Option add(const std::string& name, std::string& member, const std::string& help);
  Option add(const std::string& name, int& member, const std::string& help);
  Option add(const std::string& name, double& member, const std::string& help);
  Option add(const std::string& name, std::optional<int>& member, const std::string& help);
  Option add(const std::string& name, std::optional<double>& member, const std::string& help);
  // Of an argument: all that follow. Of an option: one value each time that it is given.
  Option add(const std::string& name, std::vector<std::string>& member, const std::string& help);
  Option add(const std::string& name, std::vector<double>& member, const std::string& help);
  Option add_flag(const std::string& name, bool& member, const std::string& help);
  Option add_read(const std::string& name, ReadOption read, const std::string& help);
  // Prints a text instead of running the command, whatever else is missing.
  void add_print(const std::string& name, std::function<std::string()> make_text,
                 const std::string& help);

 private:
  CLI::App* command_;
};

struct Command;

// Parses the line, runs the command that it names, and prints help and mistakes.
ExitCode run_command_line(int argc, char** argv, const std::vector<Command>& commands);

}  // namespace rubble
