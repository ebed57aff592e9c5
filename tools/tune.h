#pragma once

#include <functional>

#include "tools/cli/subcommand.h"
#include "tools/tune/tune_arguments.h"

namespace CLI {
class App;
}

namespace planetree::tools {

/// Analyses page traces. Returns the exit status.
int run_tune(const TuneArguments& arguments, Console& console);

/// Adds the subcommand `tune` to the command line. If given, parsing sets `action` to a call of
/// run_tune().
void add_tune(CLI::App& app, Console& console, std::function<int()>& action);

}  // namespace planetree::tools
