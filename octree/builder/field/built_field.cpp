#include "octree/builder/field/built_field.h"

#include <algorithm>

#include "octree/builder/field/field_search.h"
#include "octree/builder/job/parallel.h"
#include "octree/builder/job/phase_count.h"
#include "octree/builder/tree/stream_writer.h"
#include "octree/field/field_page.h"
#include "octree/geometry/strict_math.h"

namespace planetree::octree {

Result<BuiltField> BuiltField::build(const BuiltTrees& trees, const Region& region,
                                     std::uint64_t triangles, std::uint32_t page_bytes,
                                     BuildProgress& progress) {
  BuiltField field;
  field.page_bytes_ = page_bytes;
  const TreeInfo info = trees.surface->info();
  field.shape_ =
      FieldShape::of(region.clamped(info.core_lower), region.clamped(info.core_upper), triangles);
  if (field.shape_.count() == 0) return field;
  field.points_.resize(field.shape_.count());
  FieldSearch search(trees, field.shape_, field.points_);
  PhaseCount count(progress, BuildPhase::kBuildingField, search.tile_count());
  const auto found =
      for_each_in_parallel(search.tile_count(), [&](std::size_t tile) -> Result<void> {
        if (!search.all_fit()) return {};
        if (const auto searched = search.search(tile); !searched) return searched;
        return count.add();
      });
  if (!found) return found.error();
  if (!search.all_fit()) return BuiltField();
  return field;
}

std::uint32_t BuiltField::page_count() const { return field_pages(points_.size(), page_bytes_); }

FilePage BuiltField::encode(std::uint32_t index, std::uint32_t first_page) const {
  const std::size_t in_page = points_per_field_page(page_bytes_);
  const std::size_t first = index * in_page;
  const std::size_t end = std::min(first + in_page, points_.size());
  FieldPageHead head{};
  head.page_number = first_page + index;
  head.ordinal = index;
  head.point_count = static_cast<std::uint32_t>(end - first);
  StreamWriter bytes;
  bytes.plain(&head, sizeof head);
  for (unsigned axis = 0; axis < 3; ++axis) {
    std::vector<std::uint16_t> differences;
    std::uint16_t before = 0;
    for (std::size_t i = first; i < end; ++i) {
      const std::uint16_t at = points_[i][axis];
      differences.push_back(fold_difference(static_cast<std::uint16_t>(at - before)));
      before = at;
    }
    bytes.byte_split(differences);
  }
  FilePage page;
  page.ordinal = index;
  page.bytes = bytes.take();
  return page;
}

void BuiltField::describe(storage::ModelRecord& model) const {
  model.field_page_count = page_count();
  if (model.field_page_count == 0) return;
  for (unsigned axis = 0; axis < 3; ++axis) {
    model.field_lower[axis] = shape_.lower[axis];
    model.field_size[axis] = shape_.size[axis];
  }
  model.field_step = shape_.step;
  model.field_quantum = shape_.quantum;
}

}  // namespace planetree::octree
