#pragma once

#include "octree/nearest/coherence_cache.h"
#include "octree/nearest/nearest.h"
#include "query/answer/side_cache.h"

namespace planetree::query {

/// What one probe keeps from query to query, because the next query is often nearby. Plain
/// memory, one thread. No exact answer depends on it: answers have the same bits with it and
/// without.
struct Coherence {
  /// Off, every query starts from the root, as the first one does. For tests.
  bool is_on = true;

  octree::CoherenceCache nearest;      ///< subtrees and triangles near the last query
  octree::NearestAnswer last_nearest;  ///< of Wait::kNever: an upper bound if pages are missing
  SideCache side;                      ///< the last point whose side is known, and its mask cell
  bool side_grid_answered = true;      ///< the last lookup in the side grid found a side
  bool searched_side = false;          ///< the last side found with a distance took a mask search
};

}  // namespace planetree::query
