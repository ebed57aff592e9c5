#include "tools/manual/man_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>

#include "tools/cli/size_text.h"
#include "tools/cli/subcommand.h"

namespace planetree::tools {
namespace {

/// Text that roff shows as it is. A plain '-' would become a hyphen, which cannot be copied into a
/// command line.
std::string escaped(std::string_view text) {
  std::string roff;
  for (const char c : text) {
    if (c == '\\')
      roff += "\\e";
    else if (c == '-')
      roff += "\\-";
    else if (c == '"')
      roff += "\\(dq";
    else
      roff += c;
  }
  // A line that starts with one of these would be a request.
  if (roff.starts_with('.') || roff.starts_with('\'')) roff.insert(0, "\\&");
  return roff;
}

std::string line(std::string_view text) { return escaped(text) + '\n'; }

std::string title(const CommandSummary& command, const std::string& page) {
  std::string upper = page;
  std::transform(upper.begin(), upper.end(), upper.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return fmt::format(".TH \"{}\" 1 \"\" \"{}\" \"User Commands\"\n", escaped(upper),
                     escaped(command.version));
}

std::string name_and_synopsis(const std::string& page, const std::string& name,
                              const CommandSummary& command) {
  return ".SH NAME\n" + escaped(page) + " \\- " + line(command.description) + ".SH SYNOPSIS\n.B " +
         line(name) + line(usage_of(command));
}

std::string entries(const char* heading, const std::vector<OptionSummary>& options) {
  if (options.empty()) return {};
  std::string text = fmt::format(".SH {}\n", heading);
  for (const OptionSummary& option : options) {
    const std::string names = escaped(option.joined_names());
    const std::string value = escaped(option.value);
    text += ".TP\n";
    if (names.empty())
      text += fmt::format(".I \"{}\"\n", value);
    else if (value.empty())
      text += fmt::format(".B \"{}\"\n", names);
    else
      text += fmt::format(".BI \"{} \" \"{}\"\n", names, value);
    text += line(option.help);
  }
  return text;
}

std::string foot() {
  std::string text = ".SH NOTES\n" + line(kSuffixHelp) + ".SH EXIT STATUS\n";
  for (const ExitStatus& each : kExitStatuses)
    text += fmt::format(".TP\n.B {}\n{}", each.status, line(each.meaning));
  return text;
}

/// References to the other pages.
std::string see_also(const CommandSummary& command, const std::string& page) {
  std::vector<std::string> pages;
  if (page != command.name) pages.push_back(command.name);
  for (const CommandSummary& subcommand : command.subcommands)
    if (const std::string other = command.name + '-' + subcommand.name; other != page)
      pages.push_back(other);
  std::string text = ".SH SEE ALSO\n";
  for (const std::string& other : pages)
    text += fmt::format(".BR {} (1){}\n", escaped(other), other == pages.back() ? "" : ",");
  return text;
}

}  // namespace

std::string man_page(const CommandSummary& command) {
  std::string text = title(command, command.name);
  text += name_and_synopsis(command.name, command.name, command) + ".SH SUBCOMMANDS\n";
  for (const CommandSummary& subcommand : command.subcommands)
    text += fmt::format(".TP\n.B {}\n{}", escaped(subcommand.name), line(subcommand.description));
  return text + entries("OPTIONS", command.options) + foot() + see_also(command, command.name);
}

std::string man_page(const CommandSummary& command, const CommandSummary& subcommand) {
  const std::string page = command.name + '-' + subcommand.name;
  return title(command, page) +
         name_and_synopsis(page, command.name + ' ' + subcommand.name, subcommand) +
         entries("ARGUMENTS", subcommand.arguments) + entries("OPTIONS", subcommand.options) +
         foot() + see_also(command, page);
}

}  // namespace planetree::tools
