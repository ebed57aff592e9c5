#pragma once

#include <functional>

#include "tools/cli/subcommand.h"
#include "tools/thickness/thickness_arguments.h"

namespace CLI {
class App;
}

namespace planetree::tools {

/// Measures how thick the walls of a model are. Returns the exit status. If the points cannot be
/// read, no file is written.
int run_thickness(const ThicknessArguments& arguments, Console& console);

/// Adds the subcommand `thickness` to the command line. If given, parsing sets `action` to a call
/// of run_thickness().
void add_thickness(CLI::App& app, Console& console, std::function<int()>& action);

}  // namespace planetree::tools
