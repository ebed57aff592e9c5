#include "tools/manual/command_summary.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <set>

#include "tools/cli/subcommand_options.h"

namespace planetree::tools {
namespace {

bool has_validator(CLI::Option& option, const char* name) {
  try {
    return option.get_validator(name) != nullptr;
  } catch (const CLI::OptionNotFound&) {
    return false;
  }
}

std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  if (option.get_positional()) return names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

/// The names of other options, in alphabetical order: the set is in the order of addresses.
std::string list_of(const std::set<CLI::Option*>& others) {
  std::vector<std::string> names;
  for (const CLI::Option* other : others) names.push_back(other->get_name());
  std::sort(names.begin(), names.end());
  return fmt::format("{}", fmt::join(names, ", "));
}

/// Adds a sentence and ends it with a full stop.
void append_sentence(std::string& text, const std::string& sentence) {
  text += (text.empty() ? "" : " ") + sentence;
  if (!text.ends_with('.')) text += '.';
}

std::string help_of(const CLI::Option& option) {
  std::string help;
  append_sentence(help, option.get_description());
  if (option.get_required()) append_sentence(help, "Required");
  if (!option.get_default_str().empty())
    append_sentence(help, "Default: " + option.get_default_str());
  if (!option.get_needs().empty()) append_sentence(help, "Requires " + list_of(option.get_needs()));
  if (!option.get_excludes().empty())
    append_sentence(help, "Not together with " + list_of(option.get_excludes()));
  return help;
}

OptionSummary summary_of(CLI::Option& option) {
  OptionSummary summary;
  summary.names = names_of(option);
  if (option.get_items_expected_max() > 0) summary.value = option.get_type_name();
  if (summary.value.find('|') != std::string::npos)
    summary.choices = CLI::detail::split(summary.value, '|');
  summary.is_path = has_validator(option, SubcommandOptions::kPathCheck);
  summary.is_required = option.get_required();
  summary.help = help_of(option);
  return summary;
}

}  // namespace

std::string OptionSummary::joined_names() const {
  return fmt::format("{}", fmt::join(names, ", "));
}

CommandSummary summarize(CLI::App& app) {
  CommandSummary summary;
  summary.name = app.get_name();
  summary.version = app.version();
  summary.description = app.get_description();
  for (CLI::Option* option : app.get_options()) {
    auto& list = option->get_positional() ? summary.arguments : summary.options;
    list.push_back(summary_of(*option));
  }
  for (CLI::App* subcommand : app.get_subcommands([](CLI::App*) { return true; }))
    summary.subcommands.push_back(summarize(*subcommand));
  return summary;
}

std::string usage_of(const CommandSummary& command) {
  std::string usage = "[options]";
  if (!command.subcommands.empty()) usage += " SUBCOMMAND ...";
  for (const OptionSummary& argument : command.arguments)
    usage += argument.is_required ? ' ' + argument.value : " [" + argument.value + ']';
  for (const OptionSummary& option : command.options)
    if (option.is_required) usage += fmt::format(" {} {}", option.names.back(), option.value);
  return usage;
}

}  // namespace planetree::tools
