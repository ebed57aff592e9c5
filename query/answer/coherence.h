#pragma once

#include "octree/nearest/coherence_cache.h"
#include "octree/nearest/nearest.h"
#include "query/answer/side_cache.h"

namespace planetree::query {

/// The state that one probe keeps from query to query, because the next query is often nearby. It
/// allocates nothing. One thread at a time may use it. Exact answers have the same bits with and
/// without it.
struct Coherence {
  /// If false, every query starts from the root, as the first one does. For tests.
  bool is_on = true;

  octree::CoherenceCache nearest;      ///< subtrees and triangles near the last query
  octree::NearestAnswer last_nearest;  ///< last real-time answer; used if pages are missing
  SideCache side;                      ///< last point of known side; last mask cell
  bool side_grid_answered = true;      ///< the last lookup in the side grid found a side
  bool searched_side = false;          ///< the last closest-point query searched for the side
};

}  // namespace planetree::query
