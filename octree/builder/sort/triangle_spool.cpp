#include "octree/builder/sort/triangle_spool.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "octree/builder/sort/morton_order.h"
#include "octree/geometry/strict_math.h"

namespace planetree::octree {
namespace {

bool is_float(const Vec3& v) {
  return static_cast<double>(static_cast<float>(v.x)) == v.x &&
         static_cast<double>(static_cast<float>(v.y)) == v.y &&
         static_cast<double>(static_cast<float>(v.z)) == v.z;
}

Triangle points_of(const std::array<Vec3, 3>& corners) {
  Triangle triangle;
  for (std::size_t k = 0; k < 3; ++k) triangle[k] = {corners[k].x, corners[k].y, corners[k].z};
  return triangle;
}

Triangles widened(const Triangles& narrow) {
  Triangles wide(true);
  wide.reserve(narrow.size());
  for (std::uint32_t i = 0; i < narrow.size(); ++i) wide.add(narrow.key(i), narrow.corners(i));
  return wide;
}

}  // namespace

Result<void> TriangleSpool::triangle(std::uint64_t index, const std::array<Vec3, 3>& corners) {
  if (batches_.empty() || batches_.back().held.size() == batch_triangles_) {
    if (!batches_.empty())
      if (const auto put = spill_batch(batches_.back()); !put) return put;
    batches_.push_back({Triangles(frame_.float64), 0, 0, frame_.float64});
  }
  if (!frame_.float64 && !std::all_of(corners.begin(), corners.end(), is_float)) widen_last();
  if (frame_.triangle_count == 0) {
    frame_.input_sample = {corners[0].x, corners[0].y, corners[0].z};
    frame_.sample_triangle = index;
  }
  note(corners);
  sample_.add(corners[0]);
  batches_.back().held.add({0, index}, points_of(corners));
  ++frame_.triangle_count;
  return {};
}

void TriangleSpool::note(const std::array<Vec3, 3>& corners) {
  for (const Vec3& corner : corners) {
    const Point point(corner.x, corner.y, corner.z);
    const bool first = frame_.triangle_count == 0 && &corner == corners.data();
    frame_.input_lower = first ? point : Point(frame_.input_lower.cwiseMin(point));
    frame_.input_upper = first ? point : Point(frame_.input_upper.cwiseMax(point));
    for (const double value : {corner.x, corner.y, corner.z}) {
      const double magnitude = std::fabs(value);
      if (magnitude > 0 && (min_magnitude_ == 0 || magnitude < min_magnitude_))
        min_magnitude_ = magnitude;
    }
  }
}

void TriangleSpool::widen_last() {
  frame_.float64 = true;
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
  if (frame_.skipped_count == 0) {
    frame_.first_skipped = first_index;
    frame_.first_skipped_text = why.text();
  }
  frame_.skipped_count += count;
}

Result<void> TriangleSpool::progress(std::uint64_t bytes_done, std::uint64_t bytes_total) {
  return progress_ ? progress_(progress_context_, bytes_done, bytes_total) : Result<void>();
}

// Reads a batch that is in the file.
Result<Triangles> TriangleSpool::read_batch(const Batch& batch) const {
  std::vector<std::byte> records(batch.bytes);
  if (const auto read = file_.read(batch.offset, records); !read) return read.error();
  return Triangles(std::move(records), batch.float64);
}

// Looks at all triangles again only if some may be stray.
Result<void> TriangleSpool::find_core() {
  CoreFinder finder(sample_, frame_.input_lower, frame_.input_upper);
  for (std::size_t i = 0; finder.may_have_strays() && i < batches_.size(); ++i) {
    const bool is_held = batches_[i].held.size() > 0;
    const auto read = is_held ? Result<Triangles>(Triangles()) : read_batch(batches_[i]);
    if (!read) return read.error();
    const Triangles& triangles = is_held ? batches_[i].held : *read;
    for (std::uint32_t at = 0; at < triangles.size(); ++at) finder.add(triangles.corners(at));
  }
  const CoreFinder::Core core = finder.found();
  frame_.input_core_lower = core.lower;
  frame_.input_core_upper = core.upper;
  frame_.stray_count = core.stray_count;
  frame_.stray_edge = core.stray_edge;
  return {};
}

void TriangleSpool::choose_scale() {
  const Point &lower = frame_.input_core_lower, &upper = frame_.input_core_upper;
  // Halves, because the difference of two doubles may overflow.
  double half = (upper * 0.5 - lower * 0.5).maxCoeff();
  if (half == 0) half = std::max(lower.cwiseAbs().maxCoeff(), upper.cwiseAbs().maxCoeff()) * 0.5;
  int exponent = 0;
  if (half > 0) std::frexp(half, &exponent);
  frame_.scale_exponent = half > 0 ? -exponent : 0;
  frame_.stray_edge = std::ldexp(frame_.stray_edge, frame_.scale_exponent);
}

Result<ModelFrame> TriangleSpool::finish() {
  if (!batches_.empty())
    if (const auto put = spill_batch(batches_.back()); !put) return put.error();
  if (const auto found = find_core(); !found) return found.error();
  choose_scale();
  if (min_magnitude_ > 0 &&
      std::ldexp(min_magnitude_, frame_.scale_exponent) < std::numeric_limits<float>::min())
    frame_.float64 = true;
  return frame_;
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
