#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/triangle_distance.h"
#include "octree/page/block_table.h"
#include "octree/page/frame.h"

/// A tree as traversals see it: the data of its header, access to its pages, and the records that
/// links lead to. FrameTable and FrameReleaseHook are the interface between the cache, which holds
/// frames, and readers that keep or prefetch pointers to them.
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

/// Finds the record that a link leads to. Looks a page up only when it differs from the last one.
class LinkResolver {
 public:
  LinkResolver(const TreeInfo& tree, const PageReader& pages)
      : links_(tree.page_bytes),
        node_slots_(tree.shape.node_slots()),
        max_blocks_(max_page_blocks(tree.page_bytes)),
        pages_(pages) {}

  /// A number that no page has.
  static constexpr std::uint32_t kNoPage = ~std::uint32_t{0};

  /// Returns the node or block that `link` leads to, valid until the next call; null if its page is
  /// not available or has no such record.
  ///
  /// from  page of the node with the link, as page() returned it; kNoPage if not known
  const std::byte* find(std::uint32_t link, TraversalStats& work, std::uint32_t from = kNoPage) {
    const std::uint32_t page = links_.page(link);
    const std::uint32_t slot = links_.slot(link);
    switch_to_page_of(link, work);
    // Links within a page were checked when it was decoded. Links between pages can be checked only
    // when both pages are decoded.
    if (!frame_ || (page != from && !leads_to_record(link, slot))) return nullptr;
    return frame_ + slot * kSlotBytes;
  }
  /// Returns the block that a numbered link leads to, as find() does. Any link is allowed.
  const std::byte* find_numbered(std::uint32_t link, TraversalStats& work) {
    const std::uint32_t number = links_.number(link);
    if (!LinkFormat::is_leaf(link) || number >= max_blocks_) return nullptr;
    switch_to_page_of(link, work);
    const std::uint32_t slot = frame_ ? BlockTable(frame_).slot(number) : 0;
    return slot == 0 ? nullptr : frame_ + slot * kSlotBytes;
  }
  /// Returns whether the record is in the page that was found last.
  bool is_in_current_page(std::uint32_t link) const {
    return links_.page(link) == page_number_ && frame_;
  }
  /// Returns whether the page of the last link is available.
  bool has_page() const { return frame_ != nullptr; }
  /// Notes that the search goes on without the record found last, of this squared bound. Returns
  /// the bound.
  float skip(float bound) const {
    pages_.skip(bound);
    return bound;
  }
  /// Returns the page of the last record.
  std::uint32_t page() const { return page_number_; }

  /// A child, given by its node and its index there.
  struct Child {
    const Node* node = nullptr;
    unsigned index = 0;
  };
  /// Searches the nodes of a page for the child with `link`. Returns no node if the page is not
  /// resident or has no such child.
  Child find_parent(std::uint32_t link, std::uint32_t page) const {
    const std::byte* frame =
        pages_.peek && page != kNoPage ? pages_.peek(pages_.context, page) : nullptr;
    if (!frame) return {};
    const auto& header = *reinterpret_cast<const FrameHeader*>(frame);
    for (unsigned i = 0; i < header.node_count; ++i) {
      const unsigned slot = header.first_node_slot + i * node_slots_;
      const auto* node = reinterpret_cast<const Node*>(frame + slot * kSlotBytes);
      for (unsigned index = 0; index < node->child_count; ++index)
        if (node->link[index] == link) return {node, index};
    }
    return {};
  }

  /// Prefetches the first cache lines of a record if its page is resident. No answer depends on it.
  /// No branch depends on the link, because it would be mispredicted.
  ///
  /// kNodeLines  lines of a node to prefetch; by default those that queries nearby read
  template <std::size_t kNodeLines = kNearNodeSlots>
  [[gnu::always_inline]] void prefetch(std::uint32_t link) const {
    if (!pages_.frames.cells) return;
    const std::byte* frame = pages_.frames.frame_of(links_.page(link));
    const std::uint32_t slot = links_.slot(link);
    const std::size_t leaf = link >> 31;
    const std::byte* record = frame + slot * kSlotBytes;
#pragma GCC unroll 8
    for (std::size_t i = 0; i < kNodeLines; ++i) __builtin_prefetch(record + i * kSlotBytes);
    // For a node, the remaining prefetches repeat its last line.
    const std::byte* last = record + (kNodeLines - 1) * kSlotBytes;
#pragma GCC unroll 8
    for (std::size_t i = kNodeLines; i < kBlockLines; ++i)
      __builtin_prefetch(last += leaf * kSlotBytes);
  }

  /// Prefetches the blocks that numbered links lead to, if their pages are resident. The links are
  /// those of a mask, whose pages exist. No answer depends on it.
  void prefetch_numbered(std::span<const std::uint32_t> links) const {
    if (!pages_.frames.cells || !pages_.peek) return;
    for (const std::uint32_t link : links)
      __builtin_prefetch(pages_.frames.frame_of(links_.page(link)) + kSlotBytes +
                         links_.number(link) * sizeof(std::uint16_t));
    std::uint32_t page = kNoPage;
    const std::byte* frame = nullptr;
    for (const std::uint32_t link : links) {
      if (links_.page(link) != page) {
        page = links_.page(link);
        frame = pages_.peek(pages_.context, page);
      }
      if (!frame) continue;
      const std::byte* block = frame + BlockTable(frame).slot(links_.number(link)) * kSlotBytes;
#pragma GCC unroll 4
      for (std::size_t i = 0; i < kBlockLines; ++i) __builtin_prefetch(block + i * kSlotBytes);
    }
  }

 private:
  static constexpr std::size_t kBlockLines = 4;  // covers all of most blocks

  void switch_to_page_of(std::uint32_t link, TraversalStats& work) {
    if (is_in_current_page(link)) return;
    ++work.page_switches;
    page_number_ = links_.page(link);
    frame_ = pages_.page(pages_.context, page_number_);
  }
  bool leads_to_record(std::uint32_t link, std::uint32_t slot) const {
    const auto& header = *reinterpret_cast<const FrameHeader*>(frame_);
    // Only the root of a tree may be a block. Links that a page had to its own blocks are right.
    if (LinkFormat::is_leaf(link)) return slot >= header.first_block_slot;
    if (slot < header.first_node_slot) return false;
    const std::uint32_t offset = slot - header.first_node_slot;
    // Constant divisors: a division by node_slots_ would take as long as the node's bounds.
    const bool aligned = node_slots_ == kNodeSlots ? offset % kNodeSlots == 0
                                                   : offset % (kNodeSlots + kMomentSlots) == 0;
    return aligned && offset < header.node_count * node_slots_;
  }

  const LinkFormat links_;
  const unsigned node_slots_;
  const std::uint32_t max_blocks_;
  const PageReader& pages_;
  std::uint32_t page_number_ = kNoPage;
  const std::byte* frame_ = nullptr;
};

}  // namespace planetree::octree
