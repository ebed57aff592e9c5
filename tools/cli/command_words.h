#pragma once

#include <string>
#include <string_view>

namespace planetree::tools {

/// Returns the text of an error in words of the command. The library names members of its options,
/// which a command line does not have. They become options of the command, such as --memory, or are
/// left out. Other texts are returned as they are.
[[nodiscard]] std::string in_command_words(std::string_view text);

}  // namespace planetree::tools
