#include "tools/compare/compare_arguments.h"

#include <fmt/format.h>

#include <cmath>

#include "tools/cli/shell_word.h"
#include "tools/cli/side_option.h"

namespace planetree::tools {

std::string compare_command(const CompareArguments& arguments) {
  const CompareArguments defaults;
  std::string text = fmt::format("planetree compare {} {}", shell_word(arguments.file.string()),
                                 shell_word(arguments.other.string()));
  const auto add = [&text](const std::string& option) { text += " " + option; };
  if (arguments.kind)
    add(arguments.kind == InputKind::kMesh ? "--read-as mesh" : "--read-as points");
  if (!arguments.columns.empty())
    add("--columns " + shell_word(fmt::format("{}", fmt::join(arguments.columns.columns, ","))));
  if (arguments.tolerance) add(fmt::format("--tolerance {}", *arguments.tolerance));
  if (arguments.spacing) add(fmt::format("--spacing {}", *arguments.spacing));
  if (arguments.hausdorff_error)
    add(fmt::format("--hausdorff-error {}", *arguments.hausdorff_error));
  if (arguments.max_splits != defaults.max_splits)
    add(fmt::format("--max-splits {}", arguments.max_splits));
  if (arguments.reach) add(fmt::format("--colour-range {}", *arguments.reach));
  if (std::isfinite(arguments.max_distance))
    add(fmt::format("--max-distance {}", arguments.max_distance));
  if (arguments.is_unsigned) add("--unsigned");
  if (arguments.side_rule != defaults.side_rule)
    add(fmt::format("--side {}", name_of(arguments.side_rule)));
  if (arguments.memory_bytes != defaults.memory_bytes)
    add(fmt::format("--memory {}", arguments.memory_bytes));
  if (!arguments.output.empty()) add("-o " + shell_word(arguments.output.string()));
  if (!arguments.page.html.empty()) add("--html " + shell_word(arguments.page.html.string()));
  if (!arguments.output.empty() || !arguments.page.html.empty()) add("--force");
  return text;
}

}  // namespace planetree::tools
