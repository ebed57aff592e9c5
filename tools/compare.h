#pragma once

#include <functional>

#include "tools/cli/subcommand.h"
#include "tools/compare/compare_arguments.h"

namespace CLI {
class App;
}

namespace planetree::tools {

/// Measures how far points or a mesh deviate from a model. Returns the exit status. If the points
/// cannot be read, no file is written.
int run_compare(const CompareArguments& arguments, Console& console);

/// Adds the subcommand `compare` to the command line. If given, parsing sets `action` to a call of
/// run_compare().
void add_compare(CLI::App& app, Console& console, std::function<int()>& action);

}  // namespace planetree::tools
