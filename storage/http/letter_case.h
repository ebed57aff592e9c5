#pragma once

#include <algorithm>
#include <string_view>

namespace planetree::storage {

/// Whether a text is `small`, which has no capital letters, with letters of ASCII in any case.
constexpr bool equals_in_any_case(std::string_view text, std::string_view small) noexcept {
  return std::ranges::equal(text, small, [](char given, char wanted) {
    return (given >= 'A' && given <= 'Z' ? static_cast<char>(given | 0x20) : given) == wanted;
  });
}

}  // namespace planetree::storage
