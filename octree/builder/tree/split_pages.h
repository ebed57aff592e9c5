#pragma once

#include <cstddef>
#include <cstdint>

namespace planetree::octree {

/// Replaces each of `count` page numbers, stored with byte-stream split, by number_of(page).
template <class NumberOf>
void replace_pages(std::byte* stream, std::size_t count, const NumberOf& number_of) {
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t page = 0;
    for (std::size_t k = 0; k < sizeof page; ++k)
      page |= std::to_integer<std::uint32_t>(stream[k * count + i]) << 8 * k;
    page = number_of(page);
    for (std::size_t k = 0; k < sizeof page; ++k)
      stream[k * count + i] = static_cast<std::byte>(page >> 8 * k);
  }
}

}  // namespace planetree::octree
