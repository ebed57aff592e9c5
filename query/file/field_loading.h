#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "octree/field/field_shape.h"
#include "planetree/error.h"
#include "storage/file/page_file.h"

namespace planetree::query {

/// The coarse field of a file, in memory.
struct LoadedField {
  std::span<const octree::FieldPoint> points;  ///< empty if the file has none or it is damaged
  bool is_damaged = false;                     ///< some page of it is unreadable or damaged
};

/// Reads the field pages of a file, every n-th point along each axis (FieldShape::thinned).
///
/// memory  receives the points; as many bytes as the thinned shape has, aligned for them. Must
///         outlive the result.
/// n       1: all points
/// errors  kNoMemory, for a page's buffers
Result<LoadedField> load_field(const storage::PageFile& file, std::uint32_t n,
                               std::span<std::byte> memory);

}  // namespace planetree::query
