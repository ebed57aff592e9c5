#pragma once

#include <cstdint>
#include <vector>

#include "octree/builder/job/build_progress.h"
#include "octree/builder/tree/built_tree.h"
#include "octree/builder/tree/page_appender.h"
#include "octree/field/field_shape.h"
#include "octree/geometry/cell_grid.h"
#include "planetree/error.h"
#include "storage/file/file_layout.h"

namespace planetree::octree {

/// The coarse field of a model that is built but not written. Depends on the tree and its box
/// alone.
class BuiltField {
 public:
  /// No field.
  BuiltField() = default;

  /// Finds the field. A model has none if it is small, if a stray is nearest to a grid point, since
  /// stored points reach no farther than the grid, or if it is so far from the origin that its
  /// coordinates are rounded to more than 2^-8 quanta.
  ///
  /// trees       of the model; only the surface's is searched.
  /// region      the part of space whose surface the file has; the grid covers that of the core.
  /// triangles   those in the file.
  /// page_bytes  size of a decoded page.
  /// errors      those of TreeFrames; of `progress`.
  /// Uses the calling thread's TBB arena.
  static Result<BuiltField> build(const BuiltTrees& trees, const Region& region,
                                  std::uint64_t triangles, std::uint32_t page_bytes,
                                  BuildProgress& progress);

  std::uint32_t page_count() const;
  /// Encodes the field page of an index; the first field page of the file is `first_page`.
  FilePage encode(std::uint32_t index, std::uint32_t first_page) const;
  /// Writes the shape to the record.
  void describe(storage::ModelRecord& model) const;

  const FieldShape& shape() const { return shape_; }
  const std::vector<FieldPoint>& points() const { return points_; }

 private:
  FieldShape shape_;
  std::vector<FieldPoint> points_;
  std::uint32_t page_bytes_ = storage::kMinPageBytes;
};

}  // namespace planetree::octree
