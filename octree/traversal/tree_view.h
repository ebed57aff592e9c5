#pragma once

#include <cstddef>
#include <cstdint>

#include "octree/geometry/triangle_distance.h"
#include "octree/page/frame.h"
#include "octree/page/frame_table.h"

/// A tree as its readers see it: facts of the whole, and its pages.
namespace planetree::octree {

struct PageReader;

/// Work that goes on a step with every few pages that are read, such as asking memory for cache
/// lines of a later lookup. `step` returns false after the last one. No answer depends on it.
struct PrefetchHook {
  void* who = nullptr;
  bool (*step)(void* who, const PageReader& pages) noexcept = nullptr;
};

/// Page number to frame. `page` returns the decoded frame, or null where the
/// page cannot be had; the pointer is good until the next call, or until a keeper is told.
/// Handed on by reference: whoever keeps one must not outlive it.
struct PageReader {
  void* context = nullptr;
  const std::byte* (*page)(void* context, std::uint32_t number) noexcept = nullptr;
  /// Where `page` would find it, or null; says nothing, brings nothing. May be absent.
  const std::byte* (*peek)(void* context, std::uint32_t number) noexcept = nullptr;
  FrameTable frames{};                       ///< without cells: nothing is asked for ahead
  PrefetchHook* prefetch_hook = nullptr;     ///< one at a time; null: nothing goes on beside
  FrameReleaseHook* release_hook = nullptr;  ///< one at a time; null: frames may go with each call
};

/// What a descent must know of a tree; lengths are in the model frame.
struct TreeInfo {
  std::uint32_t page_bytes = 0;
  std::uint32_t root_link = 0;
  BlockShape shape;
  std::uint64_t record_count = 0;  ///< nodes and blocks together
  Point box_lower = Point::Zero();
  Point box_upper = Point::Zero();
  Point centre = Point::Zero();  ///< boxes and planes are relative to it
  Point sample = Point::Zero();  ///< a vertex of the triangle of least index
  std::uint64_t sample_triangle = 0;
};

/// What reading a tree took; for tests and benchmarks.
struct TraversalStats {
  std::uint64_t nodes = 0;
  std::uint64_t blocks = 0;
  std::uint64_t triangles = 0;  ///< evaluated in double
  std::uint64_t page_switches = 0;
};

}  // namespace planetree::octree
