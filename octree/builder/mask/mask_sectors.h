#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <mutex>
#include <optional>
#include <vector>

#include "octree/builder/sort/triangle_runs.h"
#include "octree/geometry/cell_grid.h"
#include "storage/spill/spill_runs.h"

namespace planetree::octree {

/// Cells with more triangles than this are divided into sectors before the mask is built, which is
/// done for each sector by itself. The mask depends on this number.
inline constexpr std::uint64_t kSectorTriangles = 1 << 18;

/// The sectors of a mask: the octree's root, divided until few triangles and caps have the centres
/// of their boxes in a cell. The mask is built for each sector by itself.
///
/// threads  any number may add parts of the model; then any number may read sectors.
class MaskSectors {
 public:
  struct Region {
    GridCell cell;
    std::uint32_t first_octant = 0;  ///< first of eight sectors; 0 if it is not divided
    /// If it is not divided: whether triangles touch it and some of it is in the region, and the
    /// winding number at each corner minus that at the least corner.
    bool touched = false;
    std::array<std::int64_t, 8> rise{};

    bool divided() const { return first_octant != 0; }
  };

  /// What one or more triangles add to a sector's rise.
  struct Rise {
    std::uint32_t sector = 0;
    std::array<std::int64_t, 8> corners{};
  };
  /// What a part of the model adds to the sectors.
  struct Part {
    std::vector<Rise> rises;              ///< of the sectors that it touches
    storage::SpillRuns::Extent visitors;  ///< triangles that touch other sectors than their own
  };

  /// lower       least corner of the core, model frame.
  /// known       region in which sides are needed; all triangles that touch it are in the model.
  /// winding     number at the least corner of the root, clamped to `known`.
  /// held_bytes  maximum, in memory, of triangles that touch other sectors than their own.
  /// file        receives the others; must outlive this.
  MaskSectors(const Point& lower, const octree::Region& known, std::int64_t winding, bool float64,
              std::uint64_t held_bytes, storage::SpillFile& file)
      : grid_(lower, known),
        lower_(lower),
        float64_(float64),
        winding_(winding),
        visitors_(Triangles::record_bytes(float64), held_bytes, file) {}

  /// Divides the root into sectors. Call it before anything else.
  ///
  /// caps        null if there are none
  /// has_strays  some triangle may be stray
  Result<void> divide(const TriangleRuns& runs, const TriangleRuns* caps, bool has_strays,
                      std::uint64_t max_triangles = kSectorTriangles);

  /// Adds a part of the model, each triangle once. Returns what was added.
  Result<Part> add(const Triangles& triangles);
  /// Adds a part whose visitors are in the file. If the part is not one of this model, returns
  /// false and adds nothing.
  bool add_extent(const Part& part);

  /// The root comes first. Octants are side by side and come after the sector that they divide.
  const std::vector<Region>& all() const { return sectors_; }
  std::size_t touched_count() const {
    return static_cast<std::size_t>(
        std::count_if(sectors_.begin(), sectors_.end(), [](const Region& r) { return r.touched; }));
  }
  const ClippedGrid& grid() const { return grid_; }
  /// The winding number at the root's least corner.
  std::int64_t winding() const { return winding_; }

  /// In how many sectors a triangle is on average, rounded down; at least 1. Needles are in many.
  /// Call it after the last part.
  std::uint64_t spread(const TriangleRuns& runs) const {
    return 1 + visitors_.size() / std::max<std::uint64_t>(runs.size(), 1);
  }

  /// All triangles that may touch a sector, in Morton order. Call it after the last part.
  Result<Triangles> read(std::size_t sector, const TriangleRuns& runs) const;

 private:
  /// Triangles, or caps, with their centres in a cell.
  struct Stretch {
    const TriangleRuns* runs = nullptr;
    TriangleRuns::Cut from, to;
  };
  /// Both of a cell.
  struct Centres {
    std::vector<Stretch> stretches;
    std::uint64_t size = 0;

    void add(Stretch stretch) {
      size += TriangleRuns::count(stretch.from, stretch.to);
      stretches.push_back(std::move(stretch));
    }
  };
  class Visit;

  Result<void> divide(std::size_t at, const Centres& centres, std::uint64_t max_triangles);
  /// Whether division of a cell separates the centres in it.
  Result<bool> separates(GridCell cell, const Centres& centres) const;
  static Result<std::array<Centres, 8>> octants_of(const GridCell& cell, const Centres& centres);
  Triangles joined(const Triangles& own, const Triangles& visitors, std::size_t sector) const;
  void sum_up(const Part& part);
  std::size_t sector_of_code(std::uint64_t code) const;

  const ClippedGrid grid_;
  const Point lower_;
  const bool float64_;
  const std::int64_t winding_;
  std::vector<Region> sectors_{Region{}};
  std::mutex mutex_;
  // Triangles that touch other sectors than their own, by sector, then index.
  storage::SpillRuns visitors_;
};

}  // namespace planetree::octree
