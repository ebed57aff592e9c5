#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "planetree/types.h"
#include "tools/cli/subcommand_options.h"

namespace planetree::tools {

/// Returns the words of parts, in the order distance, side, normal.
std::vector<std::string> part_words(std::uint32_t parts);
/// Returns the parts as a list of words with commas, as --parts takes it.
std::string parts_text(std::uint32_t parts);

/// Declares the option --parts, whose value `take` gets. `help` says what else depends on it.
SubcommandOptions::Option add_parts(SubcommandOptions& subcommand,
                                    std::function<void(std::uint32_t)> take,
                                    const std::string& help);

}  // namespace planetree::tools
