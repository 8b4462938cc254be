#include "app/command_line/completion.h"

#include <set>

namespace rubble {
namespace {

std::string join(const std::vector<std::string>& words, const std::string& between = " ") {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

bool is_folder(const OptionDescription& option) { return option.value == "DIR"; }

// The names of options of one kind, each once, over all commands: a name means one thing everywhere.
template <typename Wanted>
std::string names_where(const std::vector<CommandDescription>& commands, Wanted wanted) {
  std::set<std::string> names;
  for (const CommandDescription& command : commands)
    for (const OptionDescription& option : command.options)
      if (!option.by_place && wanted(option)) names.insert(option.names.begin(), option.names.end());
  return join({names.begin(), names.end()}, "|");
}

// The first words of a line: commands, and groups of commands once.
std::vector<std::string> first_words(const std::vector<CommandDescription>& commands) {
  std::vector<std::string> words;
  for (const CommandDescription& command : commands) {
    const std::string word = command.name.substr(0, command.name.find(' '));
    if (words.empty() || words.back() != word) words.push_back(word);
  }
  return words;
}

// "eval" to "map surface ...": what follows the name of a group.
std::vector<std::string> second_words(const std::vector<CommandDescription>& commands,
                                      const std::string& group) {
  std::vector<std::string> words;
  for (const CommandDescription& command : commands)
    if (command.name.rfind(group + " ", 0) == 0) words.push_back(command.name.substr(group.size() + 1));
  return words;
}

std::string options_of(const CommandDescription& command) {
  std::vector<std::string> names;
  for (const OptionDescription& option : command.options)
    if (!option.by_place) names.insert(names.end(), option.names.begin(), option.names.end());
  return join(names);
}

std::string bash_cases(const std::vector<CommandDescription>& commands) {
  std::string cases;
  for (const CommandDescription& command : commands)
    cases += "    '" + command.name + "') options='" + options_of(command) + "' ;;\n";
  for (const std::string& group : first_words(commands))
    if (const auto words = second_words(commands, group); !words.empty())
      cases += "    '" + group + "'|'" + group + " '*) words='" + join(words) + "' ;;\n";
  return cases;
}

// In single quotes of the shell, as part of a specification of _arguments.
std::string zsh_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
    if (c == '\'')
      out += "'\\''";
    else
      out += c;
  }
  return out;
}

std::string zsh_value(const OptionDescription& option) {
  if (option.value.empty()) return "";
  const std::string action = option.value == "KEY=VALUE" ? "_rubble_keys"
                             : is_folder(option)         ? "_files -/"
                                                         : "_files";
  return ":" + zsh_text(option.value) + ":" + action;
}

std::string zsh_option(const OptionDescription& option) {
  if (option.by_place)
    return "'" + std::string(option.several ? "*" : "") + ":" + zsh_text(option.names.front()) +
           ":_files'";
  std::string text;
  for (const std::string& name : option.names)
    text += (text.empty() ? "'" : " '") + std::string(option.several ? "*" : "") + name + "[" +
            zsh_text(option.help) + "]" + zsh_value(option) + "'";
  return text;
}

std::string zsh_cases(const std::vector<CommandDescription>& commands) {
  std::string cases;
  for (const CommandDescription& command : commands) {
    cases += "    '" + command.name + "')\n      _arguments -s";
    for (const OptionDescription& option : command.options)
      cases += " \\\n        " + zsh_option(option);
    cases += " ;;\n";
  }
  return cases;
}

std::string zsh_words(const std::string& name, const std::vector<std::pair<std::string, std::string>>& words) {
  std::string text = "  " + name + "=(";
  for (const auto& [word, summary] : words) text += "\n    '" + word + ":" + zsh_text(summary) + "'";
  return text + ")\n";
}

}  // namespace

std::string make_bash_completion(const std::vector<CommandDescription>& commands,
                                 const std::vector<std::string>& keys) {
  const auto takes = [](const OptionDescription& o) { return !o.value.empty(); };
  return "# bash completion of rubble, made by `rubble completion bash`.\n"
         "_rubble() {\n"
         "  local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]}\n"
         "  local command=${COMP_WORDS[1]} options='' words='' i\n"
         "  COMPREPLY=()\n"
         "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
         "    COMPREPLY=($(compgen -W '" +
         join(first_words(commands)) + " --help --version' -- \"$current\"))\n    return\n  fi\n" +
         "  case \"$before\" in\n"
         "    --set)\n"
         "      COMPREPLY=($(compgen -S = -W '" +
         join(keys) + "' -- \"$current\"))\n      compopt -o nospace\n      return ;;\n" + "    " +
         names_where(commands, is_folder) +
         ")\n      COMPREPLY=($(compgen -d -- \"$current\"))\n      compopt -o filenames\n"
         "      return ;;\n    " +
         names_where(commands, [&](const OptionDescription& o) { return takes(o) && !is_folder(o) && o.value != "KEY=VALUE"; }) +
         ")\n      COMPREPLY=($(compgen -f -- \"$current\"))\n      compopt -o filenames\n"
         "      return ;;\n  esac\n"
         "  [ \"$COMP_CWORD\" -gt 2 ] && command=\"$command ${COMP_WORDS[2]}\"\n"
         "  for i in 1 2; do\n"
         "    case \"$command\" in\n" +
         bash_cases(commands) +
         "    esac\n"
         "    [ -n \"$options$words\" ] && break\n"
         "    command=${COMP_WORDS[1]}\n"
         "  done\n"
         "  if [ -n \"$words\" ]; then\n"
         "    COMPREPLY=($(compgen -W \"$words\" -- \"$current\"))\n"
         "  elif [[ $current == -* ]]; then\n"
         "    COMPREPLY=($(compgen -W \"$options\" -- \"$current\"))\n"
         "  else\n"
         "    COMPREPLY=($(compgen -f -- \"$current\"))\n"
         "    compopt -o filenames\n"
         "  fi\n"
         "}\n"
         "complete -F _rubble rubble\n";
}

std::string make_zsh_completion(const std::vector<CommandDescription>& commands,
                                const std::vector<std::string>& keys) {
  std::vector<std::pair<std::string, std::string>> first;
  std::string groups, cases;
  for (const std::string& word : first_words(commands)) {
    const auto second = second_words(commands, word);
    std::string summary;
    for (const CommandDescription& command : commands)
      if (command.name == word) summary = command.summary;
    first.emplace_back(word, second.empty() ? summary : "Commands: " + join(second, ", "));
    if (second.empty()) continue;
    groups += (groups.empty() ? "" : "|") + word;
    std::vector<std::pair<std::string, std::string>> rows;
    for (const CommandDescription& command : commands)
      if (command.name.rfind(word + " ", 0) == 0)
        rows.emplace_back(command.name.substr(word.size() + 1), command.summary);
    cases += "      " + word + ")\n  " + zsh_words("words", rows) + "      ;;\n";
  }
  return "#compdef rubble\n# zsh completion of rubble, made by `rubble completion zsh`.\n"
         "_rubble_keys() {\n  local -a keys\n  keys=(" +
         join(keys) +
         ")\n  compadd -S = -a keys\n}\n\n"
         "_rubble() {\n  local command=${words[2]}\n  local -a commands\n" +
         zsh_words("commands", first) +
         "  if (( CURRENT == 2 )); then\n    _describe command commands\n    return\n  fi\n"
         "  if [[ $command == (" + groups + ") ]]; then\n"
         "    if (( CURRENT == 3 )); then\n      local -a words\n      case $command in\n" + cases +
         "      esac\n      _describe command words\n      return\n    fi\n"
         "    command=\"$command ${words[3]}\"\n    shift words\n    (( CURRENT-- ))\n  fi\n"
         "  shift words\n  (( CURRENT-- ))\n"
         "  case $command in\n" + zsh_cases(commands) +
         "  esac\n}\n\n"
         "if [ \"$funcstack[1]\" = _rubble ]; then _rubble \"$@\"; else compdef _rubble rubble; fi\n";
}

}  // namespace rubble
