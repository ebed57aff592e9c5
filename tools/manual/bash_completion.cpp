#include "tools/manual/bash_completion.h"

#include <fmt/format.h>

#include <algorithm>

namespace planetree::tools {
namespace {

// Each function sets COMPREPLY. `compopt` fails where no completion is running, as in a test.
constexpr const char* kFunctions = R"(# Completion of planetree for bash.

_planetree_words() {
  mapfile -t COMPREPLY < <(compgen -W "$1" -- "$2")
}

_planetree_paths() {
  compopt -o filenames 2>/dev/null
  mapfile -t COMPREPLY < <(compgen "$1" -- "$2")
}

)";

constexpr const char* kBeginning = R"(_planetree() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} options
  COMPREPLY=()
  # Bash splits --option=value at the equals sign.
  if [[ $current == "=" ]]; then
    current=
  elif [[ $previous == "=" ]]; then
    previous=${COMP_WORDS[COMP_CWORD - 2]}
  fi
)";

constexpr const char* kEnd = R"(    *)
      return
      ;;
  esac
  if [[ $current == -* ]]; then
    _planetree_words "$options" "$current"
  else
    _planetree_paths -f "$current"
  fi
}

complete -F _planetree planetree
)";

std::string names_of(const std::vector<OptionSummary>& options) {
  std::vector<std::string> names;
  for (const OptionSummary& option : options)
    names.insert(names.end(), option.names.begin(), option.names.end());
  return fmt::format("{}", fmt::join(names, " "));
}

/// The command that completes the value of an option. Nothing is proposed for numbers and texts.
std::string completion_of(const OptionSummary& option) {
  if (!option.choices.empty())
    return fmt::format("_planetree_words '{}' \"$current\"; ", fmt::join(option.choices, " "));
  if (!option.is_path) return {};
  return fmt::format("_planetree_paths {} \"$current\"; ", option.value == "DIR" ? "-d" : "-f");
}

std::string case_of(const CommandSummary& subcommand) {
  std::string text = fmt::format("    {})\n      case $previous in\n", subcommand.name);
  for (const OptionSummary& option : subcommand.options)
    if (!option.value.empty())
      text += fmt::format("        {}) {}return ;;\n", fmt::join(option.names, "|"),
                          completion_of(option));
  return text +
         fmt::format("      esac\n      options='{}'\n      ;;\n", names_of(subcommand.options));
}

}  // namespace

std::string bash_completion(const CommandSummary& command) {
  std::string first = names_of(command.options);
  for (const CommandSummary& subcommand : command.subcommands) first += ' ' + subcommand.name;
  std::string text = fmt::format("{}{}", kFunctions, kBeginning);
  text += fmt::format(
      "  if ((COMP_CWORD == 1)); then\n    _planetree_words '{}' \"$current\"\n    return\n  fi\n",
      first);
  text += "  case ${COMP_WORDS[1]} in\n";
  for (const CommandSummary& subcommand : command.subcommands) text += case_of(subcommand);
  return text + kEnd;
}

}  // namespace planetree::tools
