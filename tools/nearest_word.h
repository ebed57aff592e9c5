#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace planetree::tools {

/// The word that a misspelled one is meant to be: it differs by the fewest letters left out, added,
/// replaced or swapped with the next, and by not more than a third of them. Empty if there is none.
[[nodiscard]] std::optional<std::string> nearest_word(std::string_view misspelled,
                                                      const std::vector<std::string>& words);

}  // namespace planetree::tools
