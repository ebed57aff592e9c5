#include "tools/thickness/thickness_arguments.h"

#include <fmt/format.h>

#include "tools/cli/shell_word.h"
#include "tools/cli/side_option.h"

namespace planetree::tools {

std::string thickness_command(const ThicknessArguments& arguments) {
  const ThicknessArguments defaults;
  std::string text = "planetree thickness " + shell_word(arguments.file.string());
  const auto add = [&text](const std::string& option) { text += " " + option; };
  if (!arguments.points.empty()) add(shell_word(arguments.points.string()));
  if (!arguments.columns.empty())
    add("--columns " + shell_word(fmt::format("{}", fmt::join(arguments.columns.columns, ","))));
  if (arguments.max_thickness) add(fmt::format("--max-thickness {}", *arguments.max_thickness));
  if (arguments.thin) add(fmt::format("--thinner-than {}", *arguments.thin));
  if (arguments.spacing) add(fmt::format("--spacing {}", *arguments.spacing));
  if (arguments.every != defaults.every) add(fmt::format("--every {}", arguments.every));
  if (arguments.min_angle_degrees != defaults.min_angle_degrees)
    add(fmt::format("--min-angle {}", arguments.min_angle_degrees));
  if (arguments.side_rule != defaults.side_rule)
    add(fmt::format("--side {}", name_of(arguments.side_rule)));
  if (arguments.memory_bytes != defaults.memory_bytes)
    add(fmt::format("--memory {}", arguments.memory_bytes));
  const auto add_file = [&add](const char* option, const std::filesystem::path& path) {
    if (!path.empty()) add(option + shell_word(path.string()));
  };
  add_file("-o ", arguments.output);
  add_file("--csv ", arguments.rows);
  add_file("--html ", arguments.page.html);
  if (!arguments.output.empty() || !arguments.rows.empty() || !arguments.page.html.empty())
    add("--force");
  return text;
}

}  // namespace planetree::tools
