#pragma once

#include <string>

#include "tools/manual/command_summary.h"

namespace planetree::tools {

/// A script for bash that completes subcommands, options, the words that an option takes, and the
/// names of files and directories.
[[nodiscard]] std::string bash_completion(const CommandSummary& command);

}  // namespace planetree::tools
