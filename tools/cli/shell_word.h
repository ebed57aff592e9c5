#pragma once

#include <string>
#include <string_view>

namespace planetree::tools {

/// The text as one word of a shell's command line, in single quotes if it needs any.
[[nodiscard]] std::string shell_word(std::string_view text);

}  // namespace planetree::tools
