#pragma once

#include <cstdint>
#include <span>

#include "octree/geometry/predicates.h"
#include "octree/traversal/tree_view.h"

namespace planetree::octree {

/// How the winding number differs between the ends of a segment.
struct Crossings {
  std::int64_t difference = 0;  ///< winding(from) - winding(to); a sum of +1 and -1
  bool on_surface = false;      ///< `from` is on a triangle; `difference` is of a step beside it
  bool complete = true;         ///< false: pages missing or `max_work` spent, nothing is known
};

/// Counts the triangles that a segment passes through, exactly.
///
/// segment    model frame; see predicates.h for the infinitesimal steps of its
///            ends, by which a segment through a vertex or along a face counts
///            as one beside it does.
/// max_work  most nodes and blocks to visit.
/// threads    any; no allocation, no lock, no exception of its own.
/// source     "Out-of-core real-time haptic interaction on very large models",
///            section 3.3, counts crossings to a cell corner of known colour; signed
///            ones, so that doubled and overlapping surfaces are right, are ours.
Crossings count_crossings(const TreeInfo& tree, const PerturbedSegment& segment,
                          std::uint64_t max_work, const PageReader& pages,
                          TraversalStats& work) noexcept;

/// The same, of the triangles of some blocks alone.
///
/// blocks  links that need not be right: what leads to no block counts as missing.
Crossings count_crossings(const TreeInfo& tree, const PerturbedSegment& segment,
                          std::span<const std::uint32_t> blocks, std::uint64_t max_work,
                          const PageReader& pages, TraversalStats& work) noexcept;

}  // namespace planetree::octree
