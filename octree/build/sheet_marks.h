#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <tbb/enumerable_thread_specific.h>

#include "octree/build/built_mask.h"
#include "octree/build/built_tree.h"
#include "octree/build/page_appender.h"
#include "octree/build/sheet_finder.h"
#include "octree/build/tree_frames.h"
#include "planetree/error.h"

namespace planetree::octree {

/// Marks the blocks that are in sheets in the pages of a watertight model, all of which is built
/// but not written. What is marked depends on the model alone.
/// threads  any number.
class SheetMarks {
 public:
  /// Both must outlive this.
  SheetMarks(const BuiltTree& tree, const BuiltMask& mask);

  /// Marks those of a distance page, by its number.
  /// errors  those of TreeFrames.
  Result<void> mark(std::uint32_t number, FilePage& page);

 private:
  struct Line {
    alignas(kSlotBytes) std::byte bytes[kSlotBytes];
  };
  // What one thread works with.
  struct Desk {
    TreeFrames frames;
    std::vector<Line> page;  // a copy: walks may take its frame
  };

  const TreeFacts facts_;
  MaskFacts mask_;
  tbb::enumerable_thread_specific<Desk> desks_;
};

}  // namespace planetree::octree
