#pragma once

#include <cstdint>
#include <vector>

#include "tools/check/file_parts.h"
#include "tools/picture/drawing.h"
#include "tools/picture/legend.h"
#include "tools/slice/slice_cut.h"

namespace planetree::tools {

/// Outlines of one level of the tree.
struct LevelOutlines {
  std::uint32_t level = 0;
  Rgb colour;
  std::uint64_t count = 0;
  std::uint64_t left_out = 0;  ///< parts of the tree that are too small to draw
  Stroke stroke;               ///< in pixels of the raster
};

/// Outlines of the boxes of nodes and blocks that the plane cuts, by level, from the root down to
/// boxes of 4 pixels.
///
/// errors  those of descend_tree()
Result<std::vector<LevelOutlines>> cell_outlines(FileParts& parts, const SliceCut& cut);

/// Outlines of the discs of one level. Blocks above that level belong to it. Boxes of less than 2
/// pixels, at that level or above it, are left out with all that is in them.
///
/// errors  those of descend_tree()
Result<LevelOutlines> disc_outlines(FileParts& parts, const SliceCut& cut, std::uint32_t level);

}  // namespace planetree::tools
