#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <tbb/enumerable_thread_specific.h>

#include "octree/builder/mask/built_mask.h"
#include "octree/builder/mask/height_field_finder.h"
#include "octree/builder/mask/tree_frames.h"
#include "octree/builder/tree/built_tree.h"
#include "octree/builder/tree/page_appender.h"
#include "planetree/error.h"

namespace planetree::octree {

/// Marks the blocks that are in height fields, in the pages of a model that is built but not
/// written. The marks depend on the model alone.
/// threads  any number.
class HeightFieldMarks {
 public:
  /// Both arguments must outlive this.
  HeightFieldMarks(const BuiltTrees& trees, const BuiltMask& mask);

  /// Marks the blocks of a distance page.
  /// number  page number in the file.
  /// errors  those of TreeFrames.
  Result<void> mark(std::uint32_t number, FilePage& page);

 private:
  struct Line {
    alignas(kSlotBytes) std::byte bytes[kSlotBytes];
  };
  // Working memory of one thread.
  struct Workspace {
    TreeFrames frames;
    std::vector<Line> page;  // a copy: traversals may evict its frame
  };

  TreeInfo cap_info_;
  const TreeInfo info_;
  MaskInfo mask_;
  tbb::enumerable_thread_specific<Workspace> workspaces_;
};

}  // namespace planetree::octree
