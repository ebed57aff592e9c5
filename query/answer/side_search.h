#pragma once

#include <cstdint>

#include "octree/mask/mask_lookup.h"
#include "octree/mask/side_grid.h"
#include "octree/winding/crossings.h"
#include "query/answer/side.h"
#include "query/answer/side_cache.h"
#include "query/answer/side_result.h"
#include "query/model_state.h"

namespace planetree::query {

/// What a search may go on from; null where its answer may not depend on it.
struct Remembered {
  SideMemory* memory = nullptr;
  const octree::ColourMap::Spot* spot = nullptr;  ///< what look_at_colours() says
};

/// One search for the side of a point in the box of a watertight model and within its region, and
/// what it may still spend: from the point to where the winding number is known, by the crossings
/// between.
class SideSearch {
 public:
  /// All must outlive this; `reason` may be null.
  SideSearch(const ModelState& model, const octree::Point& point, std::uint64_t max_nodes,
             const octree::PageReader& pages, octree::TreeWork& work, SideReason* reason,
             const Remembered& remembered = {})
      : model_(model),
        point_(point),
        max_nodes_(max_nodes),
        pages_(pages),
        work_(work),
        reason_(reason),
        memory_(remembered.memory),
        spot_(remembered.spot),
        before_(work.nodes + work.blocks) {}

  Standing run();

  /// Whether the winding number itself is known, not its sign alone.
  bool counted() const { return counted_; }

 private:
  std::uint64_t nodes_left() const {
    const std::uint64_t spent = work_.nodes + work_.blocks - before_;
    return spent < max_nodes_ ? max_nodes_ - spent : 0;
  }
  bool ask_mask();
  bool go_from(const octree::MaskFinding& found);
  bool go_to_corner(const octree::MaskFinding& found);
  bool ask_slab(const octree::MaskFinding& found);
  template <class Grid>
  bool go_within_octant(const octree::MaskFinding& found, const Grid& grid);
  bool go_to_nearest(const octree::MaskFinding& found);
  bool go(const octree::Point& end, std::int64_t winding, SideReason::Rule rule);
  bool conclude(const octree::Point& end, std::int64_t winding, const octree::Crossings& crossings,
                SideReason::Rule rule);
  void settle(std::int64_t winding, bool on_surface);

  const ModelState& model_;
  const octree::Point& point_;
  const std::uint64_t max_nodes_;
  const octree::PageReader& pages_;
  octree::TreeWork& work_;
  SideReason* const reason_;  // null where nobody asks why
  SideMemory* const memory_;  // null where nothing is remembered
  const octree::ColourMap::Spot* const spot_;
  const std::uint64_t before_;
  Standing standing_;
  bool counted_ = false;
};

}  // namespace planetree::query
