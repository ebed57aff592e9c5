#pragma once

#include <string>

#include "tools/manual/command_summary.h"

namespace planetree::tools {

/// What `planetree --help` prints, in lines of at most 80 characters.
[[nodiscard]] std::string help_text(const CommandSummary& command);

/// What `planetree SUBCOMMAND --help` prints.
[[nodiscard]] std::string help_text(const CommandSummary& command,
                                    const CommandSummary& subcommand);

}  // namespace planetree::tools
