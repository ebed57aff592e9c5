#pragma once

#include <cstddef>
#include <cstdint>

#include "octree/geometry/triangle_distance.h"
#include "octree/page/frame.h"
#include "octree/page/frame_table.h"

/// A tree as traversals see it: the data of its header, and access to its pages.
namespace planetree::octree {

struct PageReader;

/// Work that goes on a step with every few pages that are read, such as prefetching the cache
/// lines of a later lookup. `step` returns false after the last one. No answer depends on it.
struct PrefetchHook {
  void* context = nullptr;
  bool (*step)(void* context, const PageReader& pages) noexcept = nullptr;
};

/// Access to decoded pages. `page` returns the frame of page `number`, or null if the page is not
/// available. The pointer is valid until the next call, or, if a reader sets the release hook,
/// until the hook is called. A PageReader is passed by reference; objects that keep the reference
/// must not outlive it.
struct PageReader {
  void* context = nullptr;
  const std::byte* (*page)(void* context, std::uint32_t number) noexcept = nullptr;
  /// Returns the frame of a page if it is resident, else null. Reads and reports nothing. May be
  /// absent.
  const std::byte* (*peek)(void* context, std::uint32_t number) noexcept = nullptr;
  FrameTable frames{};                       ///< empty: nothing is prefetched
  PrefetchHook* prefetch_hook = nullptr;     ///< for one reader at a time; null: it has none
  FrameReleaseHook* release_hook = nullptr;  ///< for one reader at a time; null: see `page`
};

/// What a traversal needs of a tree. Lengths and points are in the model frame.
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

/// Work done in a tree; for tests and benchmarks.
struct TraversalStats {
  std::uint64_t nodes = 0;
  std::uint64_t blocks = 0;
  std::uint64_t triangles = 0;  ///< evaluated in double
  std::uint64_t page_switches = 0;
};

}  // namespace planetree::octree
