#pragma once

#include "tools/cli/subcommand.h"

namespace planetree::tools {

/// Runs the command line of `planetree`: argv[0] is the program's name, as
/// main() has it. Returns the exit status.
int run_command(int argc, const char* const* argv, Console& console);

}  // namespace planetree::tools
