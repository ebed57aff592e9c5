#include "tools/trade/trade_arguments.h"

#include <fmt/format.h>

#include "tools/cli/layer_option.h"
#include "tools/cli/parts_option.h"
#include "tools/cli/shell_word.h"

namespace planetree::tools {

std::string trade_command(const TradeArguments& arguments) {
  const TradeArguments defaults;
  std::string text = "planetree trade " + shell_word(arguments.file.string());
  if (!arguments.points.empty()) text += " --points " + shell_word(arguments.points.string());
  if (arguments.count != defaults.count) text += fmt::format(" --count {}", arguments.count);
  if (arguments.memory_bytes != defaults.memory_bytes)
    text += fmt::format(" --memory {}", arguments.memory_bytes);
  if (arguments.layers != defaults.layers) text += " --layers " + layers_text(arguments.layers);
  if (arguments.parts != defaults.parts) text += " --parts " + parts_text(arguments.parts);
  return text + " --html " + shell_word(arguments.page.html.string()) + " --force";
}

}  // namespace planetree::tools
