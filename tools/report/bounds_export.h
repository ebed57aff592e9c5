#pragma once

#include <cstdint>
#include <functional>

#include "planetree/error.h"
#include "tools/check/file_parts.h"
#include "tools/cli/output_file.h"

namespace planetree::tools {

/// What an export of bounds has written.
struct BoundsExport {
  std::uint64_t node_discs = 0;   ///< discs of nodes
  std::uint64_t block_discs = 0;  ///< discs of blocks
  std::uint64_t boxes = 0;        ///< boxes, where there is no disc
  std::uint64_t vertices = 0, faces = 0;
  std::uint64_t bytes = 0;
  Result<void> written;  ///< error of the output, if it could not be written
};

/// Writes the bounds of one level of the tree as a binary PLY: for each node of the level, and each
/// block of the level or above, its disc as two polygons of 12 sides, one in each plane of the
/// slab. The sides touch the disc's rim from outside. What has no disc has its box. The root has
/// level 0.
///
/// Coordinates are in model units. Vertices have the colour of their kind: discs of nodes are blue,
/// those of blocks orange, boxes grey. Faces have the numbers `level`, `page` and `kind` (0, 1, 2).
///
/// progress  called with the number of each page that is passed, three times from the first page
/// on;
///           may be empty
/// memory    as descend_tree()
/// errors    those of descend_tree(); kBadArgument: the level has more vertices than a PLY can
///           number. Errors of the output are in the result.
Result<BoundsExport> export_bounds(FileParts& parts, std::uint32_t level, OutputFile& output,
                                   const std::function<void(std::uint32_t page)>& progress);

}  // namespace planetree::tools
