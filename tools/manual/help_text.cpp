#include "tools/manual/help_text.h"

#include <fmt/format.h>

#include <string_view>

#include "tools/cli/size_text.h"
#include "tools/cli/subcommand.h"

namespace planetree::tools {
namespace {

constexpr std::size_t kLineLength = 80;
constexpr std::size_t kIndent = 24;

/// Breaks text between words. All lines but the first start with `indent` blanks, and the first is
/// taken to start there.
std::string wrapped(std::string_view text, std::size_t indent) {
  std::string lines;
  std::size_t column = indent;
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(text.size(), word.size() + 1));
    if (column > indent && column + 1 + word.size() > kLineLength) {
      lines += '\n' + std::string(indent, ' ');
      column = indent;
    } else if (column > indent) {
      lines += ' ';
      ++column;
    }
    lines += word;
    column += word.size();
  }
  return lines + '\n';
}

/// A term, and its text in the second column: on the same line if the term is short.
std::string row(const std::string& term, const std::string& text) {
  std::string lines = "  " + term;
  if (lines.size() + 2 > kIndent)
    lines += '\n' + std::string(kIndent, ' ');
  else
    lines.resize(kIndent, ' ');
  return lines + wrapped(text, kIndent);
}

std::string rows(const char* heading, const std::vector<OptionSummary>& options) {
  if (options.empty()) return {};
  std::string text = fmt::format("\n{}:\n", heading);
  for (const OptionSummary& option : options) {
    const std::string names = option.joined_names();
    text +=
        row(names + (names.empty() || option.value.empty() ? "" : " ") + option.value, option.help);
  }
  return text;
}

std::string text_of(const std::string& name, const CommandSummary& command) {
  std::string text = wrapped(command.description, 0);
  text += wrapped(fmt::format("Usage: {} {}", name, usage_of(command)), 0);
  text += rows("Arguments", command.arguments);
  text += rows("Options", command.options);
  if (!command.subcommands.empty()) text += "\nSubcommands:\n";
  for (const CommandSummary& subcommand : command.subcommands)
    text += row(subcommand.name, subcommand.description);
  std::string status = "Exit status:";
  const char* separator = " ";
  for (const ExitStatus& each : kExitStatuses) {
    status += fmt::format("{}{} {}", separator, each.status, each.meaning);
    separator = ", ";
  }
  return text + '\n' + wrapped(kSuffixHelp, 0) + wrapped(status + '.', 0);
}

}  // namespace

std::string help_text(const CommandSummary& command) { return text_of(command.name, command); }

std::string help_text(const CommandSummary& command, const CommandSummary& subcommand) {
  return text_of(command.name + ' ' + subcommand.name, subcommand);
}

}  // namespace planetree::tools
