#pragma once

#include <cstddef>
#include <cstdint>

#include "octree/geometry/cell_grid.h"
#include "octree/mask/mask_lookup.h"
#include "octree/mask/side_grid.h"
#include "octree/page/mask_frame.h"
#include "octree/traversal/tree_view.h"

namespace planetree::octree {

/// Goes ahead of a look at a map of colours and of the look_up() that follows, in steps: each asks
/// memory for one of the cache lines that those two will read, and needs what the one before asked
/// for. So while something else is computed in between, nobody waits for them. Goes no farther
/// than what is in memory, and no answer depends on it.
class MaskPrefetcher {
 public:
  /// The first step. All but the point must outlive this.
  MaskPrefetcher(const MaskInfo& mask, const SideGrid& side_grid, const Point& point);

  /// Whether there is another step.
  bool goes_on() const { return next_ != Next::kNothing; }
  /// Where there is one.
  /// pages  may be asked by `peek` alone, which it has.
  void step(const PageReader& pages) noexcept;
  /// The same as a PrefetchHook takes it.
  static bool step_of(void* prefetcher, const PageReader& pages) noexcept {
    auto& self = *static_cast<MaskPrefetcher*>(prefetcher);
    self.step(pages);
    return self.goes_on();
  }

 private:
  enum class Next : std::uint8_t { kNothing, kMapRecord, kNode, kLeaf };

  void go_below(const MaskNode& node, const PageReader& pages);
  const std::byte* request_for(std::uint32_t link, const PageReader& pages) const;

  const MaskInfo& mask_;
  const Point point_;
  const SideGridRecord* record_ = nullptr;
  GridCell cell_;
  std::uint32_t link_ = 0;
  Next next_ = Next::kNothing;
};

}  // namespace planetree::octree
