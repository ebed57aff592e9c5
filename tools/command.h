#pragma once

#include "tools/cli/subcommand.h"
#include "tools/manual/command_summary.h"

namespace planetree::tools {

/// Runs the command line of `planetree`, with argv as in main(). Returns the exit status.
int run_command(int argc, const char* const* argv, Console& console);

/// The subcommands and options of `planetree`, for its manual.
CommandSummary command_summary();

}  // namespace planetree::tools
