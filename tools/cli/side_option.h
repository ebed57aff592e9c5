#pragma once

#include "planetree/types.h"
#include "tools/cli/subcommand_options.h"

namespace planetree::tools {

/// Declares the option --side of a subcommand that finds sides, which sets `rule`.
SubcommandOptions::Option add_side(SubcommandOptions& subcommand, SideRule& rule);

/// The rule's word: "solid" or "surface". Not of kOfFile, which is the default.
const char* name_of(SideRule rule);

}  // namespace planetree::tools
