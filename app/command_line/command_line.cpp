#include "app/command_line/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <sstream>
#include <string_view>
#include <type_traits>
#include <utility>

#include "app/assets/asset_library.h"
#include "app/command_line/command.h"
#include "app/command_line/manual.h"
#include "app/support/print.h"
#include "kernel/base/number_text.h"
#include "scripting/schema/schema.h"
#include "scripting/values/value.h"

namespace rubble {
namespace {

std::string to_text(const std::string& value) { return value; }
std::string to_text(int value) { return std::to_string(value); }
std::string to_text(double value) { return exact_text(value); }
template <typename T>
std::string to_text(const std::optional<T>& value) {
  return value ? to_text(*value) : "";
}
template <typename T>
std::string to_text(const std::vector<T>& values) {
  std::string text;
  for (std::size_t i = 0; i < values.size(); ++i)
    text += (i == 0 ? "" : i + 1 == values.size() ? " and " : ", ") + to_text(values[i]);
  return text;
}

// Of a real number, which is finite: CLI::Range takes NaN, and prints limits in 300 digits. help: what --help says of it.
CLI::Validator real_number(const std::string& expected, const std::string& help, std::function<bool(double)> allows) {
  const auto check = [expected, allows = std::move(allows)](std::string& text) -> std::string {
    double value = 0;
    const bool taken = CLI::detail::lexical_cast(text, value) && std::isfinite(value) && allows(value);
    return taken ? "" : "expected " + expected + ", found " + text;
  };
  return CLI::Validator(check, help);
}

template <typename T>
constexpr bool is_real = std::is_same_v<T, double> || std::is_same_v<T, std::optional<double>>;

void check_finite(CLI::Option& option) {
  option.check(real_number("a finite number", "", [](double) { return true; }));
}

template <typename T>
Option add_bound(CLI::App& command, const std::string& name, T& member, const std::string& help) {
  CLI::Option* const added = command.add_option(name, member, help);
  if constexpr (is_real<T>) check_finite(*added);
  Option option(*added, to_text(member));
  if constexpr (!std::is_same_v<T, std::string>) option.metavar("N");  // until the command names it
  return option;
}

template <typename T>
Option add_several(CLI::App& command, const std::string& name, std::vector<T>& member,
                   const std::string& help) {
  CLI::Option* const option = command.add_option(name, member, help);
  if constexpr (is_real<T>) check_finite(*option);
  if (name[0] == '-') option->allow_extra_args(false)->take_all();
  return Option(*option, to_text(member));
}

}  // namespace

Option::Option(CLI::Option& option, std::string value)
    : option_(&option), value_(std::move(value)) {}

Option& Option::metavar(const std::string& name) { return option_->type_name(name), *this; }

Option& Option::shows_default(const std::string& unit) {
  return shows_default_text(unit.empty() ? value_ : value_ + " " + unit);
}

Option& Option::shows_default_text(const std::string& text) {
  option_->description(option_->get_description() + " (default: " + text + ")");
  return *this;
}

Option& Option::required() { return option_->required(), *this; }

Option& Option::between(int least, int most) {
  return option_->check(CLI::Range(least, most, to_text(least) + ".." + to_text(most))), *this;
}

Option& Option::within(double least, double most) {
  const auto limit = [](double value) {  // 1000000, not 1e+06
    return value == std::floor(value) ? std::to_string(std::int64_t(value)) : to_text(value);
  };
  return option_->check(real_number("a number from " + limit(least) + " to " + limit(most), limit(least) + ".." + limit(most),
                                    [=](double value) { return least <= value && value <= most; })),
         *this;
}

Option& Option::positive() {
  return option_->check(real_number("a number above 0", ">0", [](double value) { return value > 0; })), *this;
}
Option& Option::non_negative() {
  return option_->check(real_number("a number of at least 0", ">=0", [](double value) { return value >= 0; })), *this;
}

Option& Option::separated_by(char delimiter) {
  // Then what follows in the same word belongs to it, and as many words as there are.
  return option_->delimiter(delimiter)->allow_extra_args(true), *this;
}

Option& Option::needs(const Option& other) { return option_->needs(other.option_), *this; }
Option& Option::needs_one_of(const Option& a, const Option& b) {
  const auto look = [a = a.option_, b = b.option_](const std::string&) -> std::string {
    return a->count() + b->count() > 0 ? "" : "has no effect without " + a->get_name() + " or " + b->get_name();
  };
  return option_->check(CLI::Validator(look, "")), *this;
}
Option& Option::excludes(const Option& other) { return option_->excludes(other.option_), *this; }

Option CommandLine::add(const std::string& name, std::string& member, const std::string& help) {
  return add_bound(*command_, name, member, help);
}
Option CommandLine::add(const std::string& name, int& member, const std::string& help) {
  return add_bound(*command_, name, member, help);
}
Option CommandLine::add(const std::string& name, double& member, const std::string& help) {
  return add_bound(*command_, name, member, help);
}
Option CommandLine::add(const std::string& name, std::optional<int>& member,
                        const std::string& help) {
  return add_bound(*command_, name, member, help);
}
Option CommandLine::add(const std::string& name, std::optional<double>& member,
                        const std::string& help) {
  return add_bound(*command_, name, member, help);
}
Option CommandLine::add(const std::string& name, std::vector<std::string>& member,
                        const std::string& help) {
  return add_several(*command_, name, member, help);
}
Option CommandLine::add(const std::string& name, std::vector<double>& member,
                        const std::string& help) {
  return add_several(*command_, name, member, help);
}

Option CommandLine::add_flag(const std::string& name, bool& member, const std::string& help) {
  return Option(*command_->add_flag(name, member, help), "");
}

Option CommandLine::add_read(const std::string& name, ReadOption read, const std::string& help) {
  const auto take = [name, read = std::move(read)](const std::string& text) {
    if (const std::string mistake = read(text); !mistake.empty())
      throw CLI::ValidationError(name, mistake);
  };
  return Option(*command_->add_option_function<std::string>(name, take, help), "");
}

void CommandLine::add_print(const std::string& name, std::function<std::string()> make_text,
                            const std::string& help) {
  const auto print = [make_text = std::move(make_text)] {
    print_out("%s\n", make_text().c_str());
    throw CLI::Success();
  };
  command_->add_flag_callback(name, print, help);
}

namespace {

// The groups, each with what --help says of it.
constexpr std::pair<std::string_view, const char*> kGroups[] = {
    {"eval", "Score trajectories, reconstructions and maps of a dataset"},
    {"assets", "Check or draw a pack of assets"},
    {"bench", "Run a benchmark of robots"},
};

CLI::App* find_subcommand(CLI::App& app, const std::string& name) {
  for (CLI::App* const command : app.get_subcommands(nullptr))
    if (command->get_name() == name) return command;
  return nullptr;
}

CLI::App& find_group(CLI::App& app, const std::string& name) {
  if (name.empty()) return app;
  if (CLI::App* const known = find_subcommand(app, name)) return *known;
  for (const auto& [group, text] : kGroups)
    if (group == name) {
      CLI::App* const added = app.add_subcommand(name, text);
      added->require_subcommand(1);
      return *added;
    }
  throw RunError("the group of commands `" + name + "` has no row in kGroups");
}

std::vector<std::string> names_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* const command : app.get_subcommands(nullptr))
    names.push_back(command->get_name());
  return names;
}

// Says so where the first word is no command.
bool is_unknown_command(const CLI::App& app, int argc, char** argv) {
  const std::string word = argc > 1 ? argv[1] : "";
  const std::vector<std::string> names = names_of(app);
  const bool known = std::find(names.begin(), names.end(), word) != names.end();
  if (word.empty() || word[0] == '-' || known) return false;
  const std::string near = nearest_name(word, names);
  print_err("no such command: `%s`%s\n`rubble --help` lists all commands\n",
            word.c_str(),
            near.empty() ? "" : (" (did you mean `" + near + "`?)").c_str());
  return true;
}

// Of every command but those that read no file.
void add_sandbox_option(const Command& command, CommandLine& line, std::string& folder) {
  const std::string name = command.name;
  if (name == "completion" || name == "manual") return;
  line.add("--sandbox", folder,
           "For missions from strangers: read files only below this folder, and write only to the output folder")
      .metavar("DIR");
}

struct DeclaredCommand {
  CLI::App* command;
  Action action;
  std::shared_ptr<std::string> sandbox;  // --sandbox; empty: none
};
using Actions = std::vector<DeclaredCommand>;

Actions declare_all(CLI::App& app, const std::vector<Command>& commands) {
  Actions actions;
  for (const Command& command : commands) {
    CLI::App& group = find_group(app, command.group);
    CLI::App* const added = group.add_subcommand(command.name, command.summary);
    CommandLine line(*added);
    actions.push_back({added, command.declare(line), std::make_shared<std::string>()});
    add_sandbox_option(command, line, *actions.back().sandbox);
  }
  return actions;
}

OptionDescription describe(const CLI::Option& option) {
  OptionDescription text;
  text.by_place = option.get_positional();
  if (text.by_place) text.names.push_back(option.get_single_name());
  for (const std::string& name : option.get_snames()) text.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) text.names.push_back("--" + name);
  text.help = option.get_description();
  if (option.get_items_expected_max() > 0) {  // "N:0..8": what it is, then what it may be
    const std::string type = option.get_type_name();
    const std::size_t colon = type.find(':');
    text.value = type.substr(0, colon);
    if (colon != std::string::npos) text.help += "; " + type.substr(colon + 1);
  }
  text.required = option.get_required();
  text.several = option.get_items_expected_max() > 1;
  return text;
}

}  // namespace

std::vector<CommandDescription> describe_commands(const std::vector<Command>& commands) {
  CLI::App app;
  const Actions actions = declare_all(app, commands);
  std::vector<CommandDescription> described;
  for (std::size_t i = 0; i < commands.size(); ++i) {
    const std::string group = commands[i].group;
    CommandDescription text{(group.empty() ? "" : group + " ") + commands[i].name,
                            commands[i].summary, {}};
    const CLI::App* const command = actions[i].command;
    for (const bool by_place : {true, false})
      for (const CLI::Option* const option : command->get_options())
        if (option->get_positional() == by_place) text.options.push_back(describe(*option));
    described.push_back(std::move(text));
  }
  return described;
}

ExitCode run_command_line(int argc, char** argv, const std::vector<Command>& commands) {
  const ProgramText text = program_text();
  CLI::App app{text.about};
  app.footer(make_footer(text));
  app.set_version_flag("--version", text.version);
  app.require_subcommand(1);
  const Actions actions = declare_all(app, commands);
  std::vector<char*> words(argv, argv + argc);
  char help[] = "--help";
  if (argc > 1 && std::string(argv[1]) == "help") {  // `rubble help eval map` is `rubble eval map --help`
    words.erase(words.begin() + 1);
    words.push_back(help);
  }
  try {
    app.parse(int(words.size()), words.data());
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0 && is_unknown_command(app, int(words.size()), words.data()))
      return ExitCode::bad_input;
    std::ostringstream out, err;
    const int code = app.exit(error, out, err);
    print_out("%s", out.str().c_str());
    print_err("%s", err.str().c_str());
    return code == 0 ? ExitCode::done : ExitCode::bad_input;
  }
  for (const DeclaredCommand& declared : actions) {
    if (!*declared.command) continue;
    if (!declared.sandbox->empty()) enter_sandbox_of_missions(*declared.sandbox);
    return declared.action();
  }
  return ExitCode::bad_input;
}

}  // namespace rubble
