#pragma once

#include "tools/cli/subcommand.h"

namespace planetree::tools {

/// Runs the command line of `planetree`, with argv as in main(). Returns the exit status.
int run_command(int argc, const char* const* argv, Console& console);

}  // namespace planetree::tools
