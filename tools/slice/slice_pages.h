#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <vector>

#include "tools/check/file_parts.h"
#include "tools/picture/rgb.h"
#include "tools/slice/slice_cut.h"

namespace planetree::tools {

/// Which page each pixel belongs to: the last page on the way down from the root whose subtrees
/// have a box around the pixel. Of the root's page, which has a box around all others, only the
/// boxes of its blocks count.
struct PageMap {
  static constexpr std::uint32_t kNone = 0xffffffff;

  std::uint32_t width = 0;
  std::vector<std::uint32_t> pages;  ///< by pixel, row by row; kNone where no box is

  /// Whether the pixel to the right or below belongs to another page.
  bool is_border(std::uint32_t column, std::uint32_t row) const;
};

/// errors  those of descend_tree()
Result<PageMap> page_map(FileParts& parts, const SliceCut& cut, const SliceRaster& raster);

/// A page of a map.
struct MappedPage {
  std::uint64_t pixels = 0;
  std::uint64_t lookups = 0;  ///< in the trace, if there is one
  Rgb colour;
};

/// The pages of a map by number, each with one of 12 colours. Neighbours have different colours, as
/// far as these suffice.
std::map<std::uint32_t, MappedPage> pages_of(const PageMap& map);

/// Counts the lookups of pages by queries, in a page trace. Their colours become those of
/// lookup_colour().
///
/// errors  those of TraceReader; kBadArgument: the trace is of another model
Result<void> count_lookups(const std::filesystem::path& trace, const std::uint64_t (&content_id)[2],
                           std::map<std::uint32_t, MappedPage>& pages);

/// Number of classes of lookups: 0, 1 to 9, 10 to 99 and so on.
inline constexpr unsigned kLookupClasses = 8;
[[nodiscard]] unsigned lookup_class(std::uint64_t lookups);
[[nodiscard]] Rgb lookup_colour(unsigned lookup_class);

}  // namespace planetree::tools
