#pragma once

#include <cstddef>
#include <string_view>

#include "planetree/types.h"

namespace planetree::tools {

/// The words for enumerators of answers in all outputs.
[[nodiscard]] std::string_view feature_word(Feature feature);
[[nodiscard]] std::string_view side_word(Side side);
[[nodiscard]] std::string_view status_word(Status status);
inline constexpr std::size_t kStatusCount = 5;
inline constexpr std::size_t kSideCount = 4;

}  // namespace planetree::tools
