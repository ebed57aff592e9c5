#include "query/file/pages_below.h"

#include <algorithm>
#include <optional>

#include "octree/geometry/octcode.h"
#include "octree/geometry/tree_limits.h"

namespace planetree::query {
namespace {

// Maximum raw bytes of a page with few nodes. One with a node of eight children has 250.
constexpr std::uint32_t kFewNodesBytes = 512;
// Levels of cells below that of the page. Cells further below are many.
constexpr unsigned kLevelsBelow = 2;
constexpr std::uint64_t kMaxBytes = std::uint64_t{256} << 10;  // stored, of all pages found

// The cells of an octcode's cell: a stretch of Morton codes.
struct Cells {
  explicit Cells(std::uint64_t octcode) {
    const octree::Cell cell = octree::cell_of_octcode(octcode);
    level = std::min(cell.level, octree::kLevels);
    const unsigned bits = std::min(3 * level + cell.within, octree::kMortonBits);
    least = octree::morton_of_octcode(octcode);
    greatest = least | ((std::uint64_t{1} << (octree::kMortonBits - bits)) - 1);
  }

  unsigned level;
  std::uint64_t least, greatest;
};

// Returns the first distance page whose octcode is not less, or nothing if that is unknown.
std::optional<std::uint32_t> first_from(const storage::PageFile& file, std::uint64_t octcode) {
  std::uint32_t first = 0, end = file.header().first_cap_page();
  while (first < end) {
    const std::uint32_t middle = first + (end - first) / 2;
    const auto entry = file.kept_entry(middle);
    if (!entry) return {};
    if (entry->octcode < octcode)
      first = middle + 1;
    else
      end = middle;
  }
  return first;
}

}  // namespace

std::size_t find_pages_below(const storage::PageFile& file, std::uint32_t page,
                             std::span<std::uint32_t> found) noexcept {
  const std::uint32_t page_end = file.header().first_cap_page();
  const auto entry = page < page_end ? file.kept_entry(page) : std::nullopt;
  if (!entry || entry->raw_bytes > kFewNodesBytes) return 0;
  const Cells cells(entry->octcode);
  found = found.first(std::min<std::size_t>(found.size(), octree::kFanOut));
  std::size_t count = 0;
  std::uint64_t bytes = 0;
  const unsigned last_level = std::min(cells.level + kLevelsBelow, octree::kLevels);
  for (unsigned level = cells.level; level <= last_level; ++level) {
    constexpr std::uint64_t kAnySplit = 3;
    const std::uint64_t least = octree::octcode_of_prefix(cells.least, 3 * level);
    const std::uint64_t greatest = octree::octcode_of_prefix(cells.greatest, 3 * level) | kAnySplit;
    const auto first = first_from(file, std::max(least, entry->octcode));
    if (!first) return count;
    for (std::uint32_t at = *first; at < page_end && count < found.size(); ++at) {
      const auto below = file.kept_entry(at);
      if (!below || below->octcode > greatest || bytes + below->stored_bytes > kMaxBytes) break;
      if (at == page) continue;
      bytes += below->stored_bytes;
      found[count++] = at;
    }
  }
  return count;
}

}  // namespace planetree::query
