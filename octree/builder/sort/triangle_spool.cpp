#include "octree/builder/sort/triangle_spool.h"

#include <utility>

#include "octree/builder/sort/morton_order.h"
#include "octree/geometry/strict_math.h"

namespace planetree::octree {
namespace {

Triangles widened(const Triangles& narrow) {
  Triangles wide(true);
  wide.reserve(narrow.size());
  for (std::uint32_t i = 0; i < narrow.size(); ++i) wide.add(narrow.key(i), narrow.corners(i));
  return wide;
}

}  // namespace

Result<void> TriangleSpool::triangle(std::uint64_t index, const std::array<Vec3, 3>& corners) {
  const bool was_wide = finder_.needs_float64();
  if (batches_.empty() || batches_.back().held.size() == batch_triangles_) {
    if (!batches_.empty())
      if (const auto put = spill_batch(batches_.back()); !put) return put;
    batches_.push_back({Triangles(was_wide), 0, 0, was_wide});
  }
  finder_.add(index, corners);
  if (finder_.needs_float64() != was_wide) widen_last();
  batches_.back().held.add({0, index}, triangle_of(corners));
  return {};
}

void TriangleSpool::widen_last() {
  batches_.back().held = widened(batches_.back().held);
  batches_.back().float64 = true;
}

Result<void> TriangleSpool::spill_batch(Batch& batch) {
  const std::span<const std::byte> records = batch.held.records();
  batch.bytes = records.size();
  if (records.size() <= held_bytes_) {
    held_bytes_ -= records.size();
    return {};
  }
  const auto offset = file_.append(records);
  if (!offset) return offset.error();
  batch.offset = *offset;
  batch.held = Triangles(batch.float64);
  return {};
}

void TriangleSpool::skipped(std::uint64_t first_index, std::uint64_t count,
                            const SkippedRecord& why) {
  finder_.skip(first_index, count, why);
}

// Reads a batch that is in the file.
Result<Triangles> TriangleSpool::read_batch(const Batch& batch) const {
  std::vector<std::byte> records(batch.bytes);
  if (const auto read = file_.read(batch.offset, records); !read) return read.error();
  return Triangles(std::move(records), batch.float64);
}

// Looks at all triangles again only if some may be stray.
Result<CoreFinder::Core> TriangleSpool::find_core() const {
  CoreFinder finder = finder_.core_finder();
  for (std::size_t i = 0; finder.may_have_strays() && i < batches_.size(); ++i) {
    const bool is_held = batches_[i].held.size() > 0;
    const auto read = is_held ? Result<Triangles>(Triangles()) : read_batch(batches_[i]);
    if (!read) return read.error();
    const Triangles& triangles = is_held ? batches_[i].held : *read;
    for (std::uint32_t at = 0; at < triangles.size(); ++at) finder.add(triangles.corners(at));
  }
  return finder.found();
}

Result<ModelFrame> TriangleSpool::finish() {
  if (!batches_.empty())
    if (const auto put = spill_batch(batches_.back()); !put) return put.error();
  const auto core = find_core();
  if (!core) return core.error();
  frame_ = finder_.found(*core);
  return frame_;
}

Result<void> TriangleSpool::finish_part(const ModelFrame& frame) {
  frame_ = frame;
  return batches_.empty() ? Result<void>() : spill_batch(batches_.back());
}

Result<Triangles> TriangleSpool::take_batch(std::size_t at) {
  Batch& batch = batches_[at];
  Triangles triangles = std::move(batch.held);
  batch.held = Triangles(batch.float64);
  if (triangles.size() == 0) {
    auto read = read_batch(batch);
    if (!read) return read;
    triangles = *std::move(read);
  }
  if (frame_.float64 && !batch.float64) triangles = widened(triangles);
  const Point lower = frame_.core_lower(), upper = frame_.core_upper();
  const auto is_stray = [&](const Triangle& corners) {
    return frame_.has_strays() && ((least_corner(corners).array() < lower.array()).any() ||
                                   (greatest_corner(corners).array() > upper.array()).any());
  };
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    Triangle corners = triangles.corners(i);
    for (Point& corner : corners) corner = frame_.scaled(corner);
    const std::uint64_t stray = is_stray(corners) ? kStrayCode : 0;
    triangles.set(i, {morton_code_of(corners, lower) | stray, triangles.index(i)}, corners);
  }
  return triangles;
}

}  // namespace planetree::octree
