#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "planetree/types.h"

namespace planetree::tools {

/// The words for enumerators of answers in all outputs.
[[nodiscard]] std::string_view feature_word(Feature feature);
[[nodiscard]] std::string_view side_word(Side side);
[[nodiscard]] std::string_view status_word(Status status);
inline constexpr std::size_t kStatusCount = 5;
inline constexpr std::size_t kSideCount = 4;

/// An enumerator as a word, and as its number for formats without words.
struct Word {
  std::string_view text;
  std::uint8_t number;
};
[[nodiscard]] inline Word named(Feature feature) {
  return {feature_word(feature), static_cast<std::uint8_t>(feature)};
}
[[nodiscard]] inline Word named(Side side) {
  return {side_word(side), static_cast<std::uint8_t>(side)};
}
[[nodiscard]] inline Word named(Status status) {
  return {status_word(status), static_cast<std::uint8_t>(status)};
}

}  // namespace planetree::tools
