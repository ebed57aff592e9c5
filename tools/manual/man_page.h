#pragma once

#include <string>

#include "tools/manual/command_summary.h"

namespace planetree::tools {

/// The man page of the whole command, planetree.1, in roff with the macros of man(7).
[[nodiscard]] std::string man_page(const CommandSummary& command);

/// The man page of a subcommand, such as planetree-build.1.
[[nodiscard]] std::string man_page(const CommandSummary& command, const CommandSummary& subcommand);

}  // namespace planetree::tools
