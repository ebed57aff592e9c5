#pragma once

#include <functional>

#include "tools/cli/subcommand.h"
#include "tools/session/touch_arguments.h"

namespace CLI {
class App;
}

namespace planetree::tools {

/// Runs a simulated haptic session and reports latency and status of its answers.
/// Returns the exit status.
int run_touch(const TouchArguments& arguments, Console& console);

/// Adds the subcommand `touch` to the command line. If given, parsing sets `action` to a call of
/// run_touch().
void add_touch(CLI::App& app, Console& console, std::function<int()>& action);

}  // namespace planetree::tools
