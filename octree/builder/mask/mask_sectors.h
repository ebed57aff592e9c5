#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <mutex>
#include <optional>
#include <vector>

#include "octree/builder/sort/triangle_runs.h"
#include "octree/geometry/clipped_grid.h"
#include "storage/spill/spill_runs.h"

namespace planetree::octree {

/// Cells of fewer triangles are not divided before the mask is built, which then takes one of
/// them at a time; the mask does depend on this number.
inline constexpr std::uint64_t kSectorTriangles = 1 << 18;

/// The octree's root, divided until few triangles have their centres in a cell: the regions,
/// in which a mask is built one by one.
///
/// threads  any number may add parts of the model; then any number may read regions.
class MaskSectors {
 public:
  struct Region {
    GridCell cell;
    std::uint32_t first_octant = 0;  ///< of eight regions; 0 in one that is not divided
    /// Of one that is not divided: whether triangles touch it, if some of it is asked for, and
    /// the winding number at each corner less that at the least.
    bool touched = false;
    std::array<std::int64_t, 8> rise{};

    bool divided() const { return first_octant != 0; }
  };

  /// What a triangle, or many, add to a region's rise.
  struct Rise {
    std::uint32_t sector = 0;
    std::array<std::int64_t, 8> corners{};
  };
  /// What a part of the model adds to the regions.
  struct Part {
    std::vector<Rise> rises;              ///< of regions it touches
    storage::SpillRuns::Extent visitors;  ///< triangles that touch other regions than their own
  };

  /// lower       of the model's box, model frame.
  /// known       where sides will be asked for: all triangles that touch it are in the model.
  /// winding     number at the least corner of the root, as far as that is in `known`.
  /// held_bytes  of triangles that touch other regions than their own may stay in memory.
  /// file        takes the rest; must outlive this.
  MaskSectors(const Point& lower, const octree::Region& known, std::int64_t winding, bool float64,
              std::uint64_t held_bytes, storage::SpillFile& file)
      : grid_(lower, known),
        lower_(lower),
        float64_(float64),
        winding_(winding),
        visitors_(Triangles::record_bytes(float64), held_bytes, file) {}

  /// First of all.
  Result<void> divide(const TriangleRuns& runs, std::uint64_t most = kSectorTriangles);

  /// A part of the model, each triangle once. Returns what was added.
  Result<Part> add(const Triangles& triangles);
  /// Adds a part whose visitors are in the file. False: it is not one of this model, nothing
  /// was added.
  bool add_extents(const Part& part);

  /// The root first, octants side by side and after the region they divide.
  const std::vector<Region>& all() const { return sectors_; }
  std::size_t touched_count() const {
    return static_cast<std::size_t>(
        std::count_if(sectors_.begin(), sectors_.end(), [](const Region& r) { return r.touched; }));
  }
  const ClippedGrid& grid() const { return grid_; }
  /// The winding number at the root's least corner.
  std::int64_t winding() const { return winding_; }

  /// All triangles that may touch a region, in Morton order. After the last part.
  Result<Triangles> read(std::size_t sector, const TriangleRuns& runs) const;

 private:
  struct Stretch {
    TriangleRuns::Cut from, to;
    std::uint64_t size = 0;
  };
  class Visit;

  Result<void> divide(std::size_t at, const Stretch& stretch, const TriangleRuns& runs,
                      std::uint64_t most, unsigned wasted);
  Result<std::array<Stretch, 8>> octants_of(std::size_t at, const Stretch& stretch,
                                            const TriangleRuns& runs) const;
  Triangles joined(const Triangles& own, const Triangles& visitors, std::size_t sector) const;
  void sum_up(const Part& part);
  std::size_t sector_of_code(std::uint64_t code) const;

  const ClippedGrid grid_;
  const Point lower_;
  const bool float64_;
  const std::int64_t winding_;
  std::vector<Region> sectors_{Region{}};
  std::mutex mutex_;
  storage::SpillRuns visitors_;  // by region, then index: that touch another than their own
};

}  // namespace planetree::octree
