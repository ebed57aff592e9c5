#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include <tbb/enumerable_thread_specific.h>

#include "octree/builder/mask/tree_frames.h"
#include "octree/builder/tree/built_tree.h"
#include "octree/field/field_shape.h"
#include "octree/traversal/tree_view.h"
#include "planetree/error.h"

namespace planetree::octree {

/// Finds the surface points of a field, one tile of the grid at a time. Any number of threads.
class FieldSearch {
 public:
  /// Grid points along each axis of a tile.
  static constexpr std::uint32_t kTile = 8;

  /// All arguments must outlive this. points  one for each point of `shape`; receives the result.
  FieldSearch(const BuiltTrees& trees, const FieldShape& shape, std::vector<FieldPoint>& points);

  std::size_t tile_count() const { return tiles_.size(); }
  /// Finds the points of a tile. Tiles of near numbers are near in space.
  /// errors  those of TreeFrames.
  Result<void> search(std::size_t tile);

  /// Whether all points that were found can be stored, within the uncertainty of the field, and
  /// took no more work than searches of ordinary surfaces do. Depends on the model alone, once it
  /// is false or all tiles are searched.
  bool all_fit() const { return all_fit_.load(std::memory_order_relaxed); }

 private:
  struct Tile {
    std::uint64_t morton;
    std::array<std::uint32_t, 3> first;  // grid point
  };

  // Finds the surface point of a grid point. Returns false if it cannot be stored.
  bool find(const Point& at, const PageReader& pages, TraversalStats& work,
            FieldPoint& stored) const;

  const FieldShape& shape_;
  std::vector<FieldPoint>& points_;
  TreeInfo cap_info_;
  const TreeInfo info_;  // without a sample
  std::vector<Tile> tiles_;
  std::atomic<bool> all_fit_{true};
  std::atomic<std::uint64_t> units_{0};  // of work
  tbb::enumerable_thread_specific<TreeFrames> frames_;
};

}  // namespace planetree::octree
