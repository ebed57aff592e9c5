#pragma once

#include <cstdint>
#include <functional>

#include "octree/builder/sort/triangle_spool.h"
#include "octree/builder/sort/triangles.h"
#include "storage/spill/spill_runs.h"

namespace planetree::octree {

/// All triangles of a model, to be had by their place on the Morton curve.
/// threads  any number may cut and read.
class TriangleRuns {
 public:
  using Cut = storage::SpillRuns::Cut;
  using Extent = storage::SpillRuns::Extent;

  /// held_bytes  of them may stay in memory.
  /// file        takes the others; must outlive this.
  TriangleRuns(bool float64, std::uint64_t held_bytes, storage::SpillFile& file)
      : float64_(float64), runs_(Triangles::record_bytes(float64), held_bytes, file) {}

  /// Takes every chunk of an intake. Uses the calling thread's TBB arena.
  /// done  told, on any thread, after each chunk.
  Result<void> take(TriangleSpool& spool, const std::function<void()>& done);

  /// Takes some triangles, in any order.
  Result<void> add(Triangles triangles);

  /// Takes runs that are in the file already.
  void add_extents(const std::vector<Extent>& extents) {
    for (const Extent& extent : extents) runs_.add_extents(extent);
  }
  /// Where the runs are, if none was held.
  std::vector<Extent> extents() const { return runs_.extents(); }

  bool float64() const { return float64_; }
  std::uint64_t size() const { return runs_.size(); }
  Cut begin() const { return runs_.begin(); }
  Cut end() const { return runs_.end(); }
  /// The first triangles whose keys are not before (code, index).
  Result<Cut> cut(std::uint64_t code, std::uint64_t index = 0) const {
    return runs_.cut({code, index});
  }
  static std::uint64_t count(const Cut& from, const Cut& to) {
    return storage::SpillRuns::count(from, to);
  }

  /// The triangles between two cuts, fewer than 2^32, in an order that depends on the runs.
  Result<Triangles> read_any_order(const Cut& from, const Cut& to) const;
  /// The same by code, then index.
  Result<Triangles> read(const Cut& from, const Cut& to) const;

 private:
  bool float64_;
  storage::SpillRuns runs_;
};

}  // namespace planetree::octree
