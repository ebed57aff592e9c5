#pragma once

#include <cstdint>
#include <span>

#include "octree/geometry/predicates.h"
#include "octree/traversal/tree_view.h"

namespace planetree::octree {

/// Change of the winding number of a closed surface, the model's surface with its caps, along a
/// segment.
struct Crossings {
  std::int64_t difference = 0;  ///< winding(from) - winding(to); a sum of +1 and -1
  bool on_surface = false;  ///< `from` is on a triangle of the model's surface; `difference` holds
                            ///< once it is perturbed
  bool complete = true;     ///< false: pages missing or `max_work` spent; nothing is known
};

/// Counts the triangles and caps that a segment passes through, exactly and with signs.
///
/// segment   model frame. Its ends are moved by the infinitesimal steps of predicates.h, so that a
///           segment through a vertex or along a face counts as one beside it does.
/// max_work  maximum work in units, see WorkLimit.
/// work      counters that the walk adds to.
/// threads   any; no allocation, no lock, no exception of its own.
/// source    "Out-of-core real-time haptic interaction on very large models", section 3.3, counts
///           crossings to a cell corner of known colour. Signed crossings are planetree's own; they
///           are right for doubled and overlapping surfaces too.
Crossings count_crossings(const TreeInfo& tree, const PerturbedSegment& segment,
                          std::uint64_t max_work, const PageReader& pages,
                          TraversalStats& work) noexcept;

/// Counts the crossings with the triangles of some blocks only, of the surface or of its caps;
/// otherwise as above.
///
/// blocks  numbered links (LinkFormat) to the blocks. They need not be valid: a link that leads to
///         no block counts as one to a missing page.
Crossings count_crossings(const TreeInfo& tree, const PerturbedSegment& segment,
                          std::span<const std::uint32_t> blocks, std::uint64_t max_work,
                          const PageReader& pages, TraversalStats& work) noexcept;

}  // namespace planetree::octree
