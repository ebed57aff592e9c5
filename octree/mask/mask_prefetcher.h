#pragma once

#include <cstddef>
#include <cstdint>

#include "octree/geometry/cell_grid.h"
#include "octree/mask/mask_lookup.h"
#include "octree/mask/side_grid.h"
#include "octree/page/mask_frame.h"
#include "octree/traversal/tree_view.h"

namespace planetree::octree {

/// Prefetches the cache lines that a lookup in a side grid and the look_up() after it will read. It
/// works in steps. Each step prefetches one line and reads the line that the step before has
/// prefetched. The caller computes something else between steps, so that nothing waits for memory.
/// Only resident pages are read. No answer depends on this class.
class MaskPrefetcher {
 public:
  /// Takes the first step. `mask` and `side_grid` must outlive this.
  MaskPrefetcher(const MaskInfo& mask, const SideGrid& side_grid, const Point& point);

  /// Whether there is another step.
  bool goes_on() const { return next_ != Next::kNothing; }
  /// Takes the next step. Requires goes_on().
  ///
  /// pages  only its `peek` is called, which it must have.
  void step(const PageReader& pages) noexcept;
  /// The same as a PrefetchHook takes it.
  static bool step_of(void* prefetcher, const PageReader& pages) noexcept {
    auto& self = *static_cast<MaskPrefetcher*>(prefetcher);
    self.step(pages);
    return self.goes_on();
  }

 private:
  enum class Next : std::uint8_t { kNothing, kGridRecord, kNode, kLeaf };

  void go_below(const MaskNode& node, const PageReader& pages);
  const std::byte* prefetch_at(MaskLink link, const PageReader& pages) const;

  const MaskInfo& mask_;
  const Point point_;
  const SideGridRecord* record_ = nullptr;
  GridCell cell_;
  MaskLink link_ = 0;
  Next next_ = Next::kNothing;
};

}  // namespace planetree::octree
