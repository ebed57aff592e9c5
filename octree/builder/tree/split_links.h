#pragma once

#include <cstddef>
#include <cstdint>

namespace planetree::octree {

/// Replaces each of `count` links, stored with byte-stream split, by replace(link).
template <class Replace>
void replace_links(std::byte* stream, std::size_t count, const Replace& replace) {
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t link = 0;
    for (std::size_t k = 0; k < sizeof link; ++k)
      link |= std::to_integer<std::uint32_t>(stream[k * count + i]) << 8 * k;
    link = replace(link);
    for (std::size_t k = 0; k < sizeof link; ++k)
      stream[k * count + i] = static_cast<std::byte>(link >> 8 * k);
  }
}

}  // namespace planetree::octree
