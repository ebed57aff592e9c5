#include <fmt/format.h>

#include "tools/cli/layer_option.h"
#include "tools/cli/policy_option.h"
#include "tools/cli/shell_word.h"
#include "tools/session/touch_page.h"

namespace planetree::tools {

std::string touch_command(const TouchArguments& arguments) {
  const TouchArguments defaults;
  std::string text = arguments.is_scene ? "planetree touch --scene " : "planetree touch ";
  text += shell_word(arguments.file.string());
  const auto add_number = [&text](const char* option, auto value, auto standard) {
    if (value != standard) text += fmt::format(" {} {}", option, value);
  };
  const auto add_file = [&text](const char* option, const std::filesystem::path& path) {
    if (!path.empty()) text += fmt::format(" {} {}", option, shell_word(path.string()));
  };
  add_number("--seconds", arguments.seconds, defaults.seconds);
  add_number("--rate", arguments.rate_hz, defaults.rate_hz);
  // Without it the scene file decides.
  if (arguments.is_scene)
    text += fmt::format(" --memory {}", arguments.memory_bytes);
  else
    add_number("--memory", arguments.memory_bytes, defaults.memory_bytes);
  if (arguments.motion != defaults.motion)
    text += fmt::format(" --path {}", name_of(arguments.motion));
  if (arguments.radius > 0) text += fmt::format(" --tool sphere --radius {}", arguments.radius);
  if (arguments.policy != defaults.policy)
    text += fmt::format(" --policy {}", name_of(arguments.policy));
  if (arguments.layers != defaults.layers) text += " --layers " + layers_text(arguments.layers);
  if (arguments.is_deterministic) text += " --deterministic";
  if (arguments.latency_is_given) text += fmt::format(" --latency {}ns", arguments.latency_ns);
  add_number("--seed", arguments.seed, defaults.seed);
  if (arguments.cold) text += " --cold";
  if (arguments.no_io_uring) text += " --no-io-uring";
  if (arguments.read_ahead) text += " --read-ahead";
  add_file("--ticks", arguments.ticks);
  add_file("--trace", arguments.trace);
  add_file("--html", arguments.page.html);
  return text + " --force";
}

}  // namespace planetree::tools
