#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "tools/tune/references.h"

/// Page lookups of made traces.
namespace planetree::tools {

/// Pages looked up, the first sixteenth of them while the model was opened.
struct MadeTrace {
  std::vector<std::uint32_t> pages;
  std::size_t opening() const { return pages.size() / 16; }
};

/// Every fifth page is an upper page, the root among them.
inline bool is_upper(std::uint32_t page) { return page % 5 == 0; }

inline References references_of(const MadeTrace& trace) {
  References references;
  for (std::size_t i = 0; i < trace.pages.size(); ++i) {
    if (i == trace.opening()) references.end_opening();
    references.add(trace.pages[i]);
  }
  references.set_upper(References::kRootPage);
  for (const std::uint32_t page : trace.pages)
    if (is_upper(page)) references.set_upper(page);
  return references;
}

/// Lookups of `pages` pages, of which few are looked up often, one in eight twice or more in a row,
/// and one in sixteen is of the root.
inline MadeTrace skewed_trace(std::size_t lookups, std::uint32_t pages, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  MadeTrace trace;
  std::uint32_t page = 1;
  for (std::size_t i = 0; i < lookups; ++i) {
    const std::uint64_t bits = random();
    if (bits % 8 != 0) {
      const double share = static_cast<double>(bits >> 11) * 0x1p-53;
      page = 1 + static_cast<std::uint32_t>(share * share * share * pages);
    }
    if (bits % 16 == 1) page = References::kRootPage;
    trace.pages.push_back(page);
  }
  return trace;
}
inline References skewed_references(std::size_t lookups, std::uint32_t pages, std::uint64_t seed) {
  return references_of(skewed_trace(lookups, pages, seed));
}

/// Lookups of a walk among `pages` pages, which returns to where it was.
inline MadeTrace walked_trace(std::size_t lookups, std::uint32_t pages, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  MadeTrace trace;
  std::uint32_t at = pages / 2;
  for (std::size_t i = 0; i < lookups; ++i) {
    const std::uint64_t bits = random();
    if (bits % 4 == 0) at = static_cast<std::uint32_t>((at + (bits >> 2) % 3 + pages - 1) % pages);
    trace.pages.push_back(at);
  }
  return trace;
}
inline References walked_references(std::size_t lookups, std::uint32_t pages, std::uint64_t seed) {
  return references_of(walked_trace(lookups, pages, seed));
}

}  // namespace planetree::tools
