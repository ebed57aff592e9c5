#pragma once

#include <functional>

#include "tools/cli/subcommand.h"
#include "tools/session/touch_arguments.h"

namespace CLI {
class App;
}

namespace planetree::tools {

/// Holds a simulated haptic session and reports how late and how certain its answers were.
/// Returns the exit status.
int run_touch(const TouchArguments& arguments, Console& console);

/// Adds the verb `touch` to the command line. If a person gives it, parsing
/// sets `action` to what runs it.
void add_touch(CLI::App& app, Console& console, std::function<int()>& action);

}  // namespace planetree::tools
