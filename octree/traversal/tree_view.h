#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/triangle_distance.h"
#include "octree/page/frame.h"

/// A tree as traversals see it: the data of its header, and access to its pages. FrameTable and
/// FrameReleaseHook are the interface between the cache, which holds frames, and readers that keep
/// or prefetch pointers to them.
namespace planetree::octree {

/// Addresses of frames for prefetching. Nothing is read through these addresses, so that a page may
/// be evicted meanwhile.
struct FrameTable {
  const std::atomic<std::uint32_t>* cells = nullptr;  ///< frame + 1; 0: not resident
  const std::byte* frames = nullptr;
  std::uint64_t stride_bytes = 0;  ///< distance from frame to frame

  /// Returns the frame of a page, or some other page's frame if the page is not resident. Has no
  /// branch.
  const std::byte* frame_of(std::uint32_t page) const {
    const std::uint32_t cell = cells[page].load(std::memory_order_relaxed);
    return frames + stride_bytes * (cell - static_cast<std::uint32_t>(cell != 0));
  }
};

/// Callback of a reader that keeps pointers to frames between calls. It is called before those
/// frames may be reused.
struct FrameReleaseHook {
  void* context = nullptr;
  void (*on_release)(void* context) noexcept = nullptr;
};

struct PageReader;

/// Work that goes on a step with every few pages that are read, such as prefetching the cache
/// lines of a later lookup. `step` returns false after the last one. No answer depends on it.
struct PrefetchHook {
  void* context = nullptr;
  bool (*step)(void* context, const PageReader& pages) noexcept = nullptr;
};

/// What searches tell of the pages that were not available, for a trace. No answer depends on it.
struct MissHook {
  /// A search goes on without what the page missed last holds. `bound` is its squared bound.
  void (*on_skip)(void* context, float bound) noexcept;
  /// Pages skipped with a bound up to `threshold` could have changed the answer.
  void (*need_within)(void* context, float threshold) noexcept;
  /// So could all pages missed so far of which on_skip was not called.
  void (*need_others)(void* context) noexcept;
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
  const MissHook* miss_hook = nullptr;       ///< its `context` is that of this; null: none

  /// The calls of `miss_hook`.
  void skip(float bound) const noexcept {
    if (miss_hook) miss_hook->on_skip(context, bound);
  }
  void need_within(float threshold) const noexcept {
    if (miss_hook) miss_hook->need_within(context, threshold);
  }
  void need_others() const noexcept {
    if (miss_hook) miss_hook->need_others(context);
  }
};

/// What a traversal needs of a tree. Lengths and points are in the model frame.
struct TreeInfo {
  std::uint32_t page_bytes = 0;
  std::uint32_t root_link = 0;
  std::uint32_t first_page = 0;  ///< first page of the tree in the file
  BlockShape shape;
  std::uint64_t record_count = 0;  ///< nodes and blocks together
  Point box_lower = Point::Zero();
  Point box_upper = Point::Zero();
  Point core_lower = Point::Zero();  ///< box of all triangles but the strays
  Point core_upper = Point::Zero();
  Point centre = Point::Zero();  ///< boxes and planes are relative to it
  Point sample = Point::Zero();  ///< a vertex of the triangle of least index
  std::uint64_t sample_triangle = 0;
  bool has_strays = false;                   ///< some triangle is not in the core
  double stray_edge = 0;                     ///< see storage::ModelRecord::stray_edge
  double bound_slack = kAbsoluteBoundSlack;  ///< octree::bound_slack() of stray_edge
  /// Tree of the caps that close the surface; null: the surface is watertight, or this is a tree of
  /// caps. Its nodes have moments; otherwise blocks have the shape of the surface's.
  const TreeInfo* caps = nullptr;

  /// Returns whether a page of the file, of the surface or of its caps, is of the caps.
  bool is_of_caps(std::uint32_t page) const { return caps && page >= caps->first_page; }
  void set_strays(std::uint64_t count, double edge) {
    has_strays = count > 0;
    stray_edge = edge;
    bound_slack = octree::bound_slack(edge);
  }
  /// Returns a length S such that the farthest corner of a triangle at distance d from a query is
  /// at most 2 d + S away. kMaxDiagonal bounds the edges in the core. A stray that may be nearer to
  /// the core than it is long has edges up to stray_edge. Other strays are no longer than their gap
  /// to the core, which is at most the sum of d and of the query's distance from the centre.
  double span(const Point& query) const {
    return has_strays ? std::max(kMaxDiagonal, stray_edge) + 4 * (query - centre).norm()
                      : kMaxDiagonal;
  }
};

/// Work done in a tree; for tests and benchmarks.
struct TraversalStats {
  std::uint64_t nodes = 0;
  std::uint64_t blocks = 0;
  std::uint64_t triangles = 0;  ///< evaluated in double
  std::uint64_t page_switches = 0;
  std::uint64_t units = 0;  ///< units of work, see WorkLimit
};

}  // namespace planetree::octree
