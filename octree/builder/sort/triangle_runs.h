#pragma once

#include <cstdint>
#include <functional>

#include "octree/builder/sort/triangle_spool.h"
#include "octree/builder/sort/triangles.h"
#include "storage/spill/spill_runs.h"

namespace planetree::octree {

/// All triangles of a model, in sorted runs, to be read by their position in the Morton order.
/// threads  any number may cut and read.
class TriangleRuns {
 public:
  using Cut = storage::SpillRuns::Cut;
  using Extent = storage::SpillRuns::Extent;

  /// held_bytes  maximum of triangles in memory.
  /// file        receives the others; must outlive this.
  /// packing     of the triangles in the file.
  TriangleRuns(bool float64, std::uint64_t held_bytes, storage::SpillFile& file,
               storage::Packing packing = storage::Packing::kNone)
      : float64_(float64), runs_(Triangles::record_bytes(float64), held_bytes, file, packing) {}

  /// Takes every batch of a spool. Uses the calling thread's TBB arena.
  /// done  called after each batch, on any thread. Its error ends the taking and is returned.
  Result<void> take(TriangleSpool& spool, const std::function<Result<void>()>& done);

  /// Adds triangles, in any order, as one run.
  Result<void> add(Triangles triangles);

  /// Adds runs that are in the file already.
  void add_extent(const std::vector<Extent>& extents) {
    for (const Extent& extent : extents) runs_.add_extent(extent);
  }
  /// Where the runs are in the file, if none is in memory.
  std::vector<Extent> extents() const { return runs_.extents(); }

  bool float64() const { return float64_; }
  std::uint64_t size() const { return runs_.size(); }
  Cut begin() const { return runs_.begin(); }
  Cut end() const { return runs_.end(); }
  /// Cuts before the first triangles whose keys are not less than (code, index).
  Result<Cut> cut(std::uint64_t code, std::uint64_t index = 0) const {
    return runs_.cut({code, index});
  }
  static std::uint64_t count(const Cut& from, const Cut& to) {
    return storage::SpillRuns::count(from, to);
  }

  /// The triangles between two cuts, fewer than 2^32. Their order depends on the runs.
  Result<Triangles> read_any_order(const Cut& from, const Cut& to) const;
  /// As read_any_order(), sorted by code, then index.
  Result<Triangles> read(const Cut& from, const Cut& to) const;

 private:
  bool float64_;
  storage::SpillRuns runs_;
};

}  // namespace planetree::octree
