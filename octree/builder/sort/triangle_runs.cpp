#include "octree/builder/sort/triangle_runs.h"

#include <utility>

#include "octree/builder/job/parallel.h"
#include "octree/geometry/strict_math.h"

namespace planetree::octree {

Result<void> TriangleRuns::take(TriangleSpool& spool, const std::function<Result<void>()>& done) {
  return for_each_in_parallel(spool.batch_count(), [&](std::size_t i) -> Result<void> {
    Result<Triangles> batch = spool.take_batch(i);
    if (!batch) return batch.error();
    const auto added = add(*std::move(batch));
    return added ? done() : added;
  });
}

Result<void> TriangleRuns::add(Triangles triangles) {
  triangles.sort();
  const auto added = runs_.add(triangles.take_records());
  if (!added) return added.error();
  return {};
}

Result<Triangles> TriangleRuns::read_any_order(const Cut& from, const Cut& to) const {
  auto records = runs_.read(from, to);
  if (!records) return records.error();
  return Triangles(*std::move(records), float64_);
}

Result<Triangles> TriangleRuns::read(const Cut& from, const Cut& to) const {
  auto triangles = read_any_order(from, to);
  if (triangles) triangles->sort();
  return triangles;
}

}  // namespace planetree::octree
