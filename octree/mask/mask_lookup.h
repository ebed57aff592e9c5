#pragma once

#include <cstddef>
#include <cstdint>

#include "octree/geometry/cell_grid.h"
#include "octree/page/mask_frame.h"
#include "octree/traversal/tree_view.h"

namespace planetree::octree {

/// Facts of a mask that a lookup needs.
struct MaskInfo {
  std::uint32_t page_bytes = 0;
  std::uint32_t first_page = 0;
  std::uint32_t page_count = 0;  ///< 0: the model has no mask
  Point lower = Point::Zero();   ///< least corner of the model's core, model frame
  bool beside_strays = false;    ///< surface may lie beyond the root cell

  /// Returns whether a point of the model's box is in the root cell.
  bool reaches(const Point& point) const {
    return !beside_strays ||
           ((point.array() >= lower.array()).all() && (point.array() <= lower.array() + 2.0).all());
  }
};

/// Returns a triangle in plane `index` of the planes that follow a page's records.
inline Triangle mask_plane(const double* planes, unsigned index) {
  const double* at = planes + std::size_t{kPlaneSlots} * index;
  return {Point(at[0], at[1], at[2]), Point(at[3], at[4], at[5]), Point(at[6], at[7], at[8])};
}

/// What the mask knows about a point.
struct MaskLookup {
  enum class Kind {
    kColour,   ///< a white, black or inverted cell: only the sign of `winding` has a meaning
    kPlanes,   ///< a special cell: `winding` and `on_surface` are known
    kCorners,  ///< a grey cell: `corners` of `cell` are known, or `listed` and `blocks`
    kNothing,  ///< nothing: no mask, a page or work is missing, or the corners are not stated
  };
  Kind kind = Kind::kNothing;
  int winding = 0;          ///< of the perturbed point
  bool on_surface = false;  ///< the point itself is on the surface
  GridCell cell;            ///< the smallest cell of the mask that was reached
  MaskCorners corners{};    ///< corner numbers of `cell`, if it is not listed
  MaskListed listed{};      ///< record of a listed cell, which has its corner numbers
  MaskBlocks blocks;        ///< list of a listed cell; else empty
};

/// Finds the cell of the mask that a point is in.
///
/// point     within the model's box, model frame. Outside of the root cell nothing is found.
/// max_work  maximum work in units, see WorkLimit: one for each node, and those of a special cell's
///           planes.
/// work      counters that the lookup adds to.
/// threads   any; no allocation, no lock, no exception.
MaskLookup look_up(const MaskInfo& mask, const Point& point, std::uint64_t max_work,
                   const PageReader& pages, TraversalStats& work) noexcept;

/// Finds the records of a mask by their links. Looks a page up only if it is not the last one.
/// Pointers are valid until the next lookup of a page.
class MaskRecords {
 public:
  MaskRecords(const MaskInfo& mask, const PageReader& pages)
      : links_(mask.page_bytes),
        first_page_(mask.first_page),
        page_count_(mask.page_count),
        pages_(pages) {}

  /// Returns the record of the mask's root; null if its page is missing.
  const std::byte* root(TraversalStats& work) {
    switch_to(0, work);
    return frame_ ? slot(header().first_record_slot) : nullptr;
  }
  bool root_is_node() const { return is_mask_node(frame_, header().first_record_slot); }

  /// Returns what a link leads to; null if its page is not resident.
  const std::byte* peek(MaskLink link) const {
    const std::uint32_t page = links_.page(link);
    const std::byte* frame = frame_;
    if (page != page_)
      frame = pages_.peek && page < page_count_ ? pages_.peek(pages_.context, first_page_ + page)
                                                : nullptr;
    return frame ? frame + links_.slot(link) * kMaskSlotBytes : nullptr;
  }

  /// Prefetches the first two cache lines of what a link leads to. If its page is not resident, it
  /// prefetches lines of another page, which does no harm.
  static void prefetch(const MaskInfo& mask, MaskLink link, const FrameTable& frames) {
    const MaskLinkFormat links(mask.page_bytes);
    const std::uint32_t page = links.page(link);
    if (!frames.cells || page >= mask.page_count) return;
    const std::byte* at =
        frames.frame_of(mask.first_page + page) + links.slot(link) * kMaskSlotBytes;
    __builtin_prefetch(at);
    __builtin_prefetch(at + 64);
  }

  /// Returns the record of a grey octant of `node`; null as record() does. `node` is the last
  /// record found, or a copy that was made before any was.
  const std::byte* child(const MaskNode& node, unsigned octant, TraversalStats& work) {
    const MaskLink link = child_link(node, octant);
    // Links within a page were checked when it was decoded.
    if (links_.page(link) == page_ && frame_) return slot(links_.slot(link));
    return record(link, node.is_leaf(octant), work);
  }
  /// Returns the link to the record of a grey octant.
  MaskLink child_link(const MaskNode& node, unsigned octant) const {
    const unsigned below = (1U << octant) - 1;
    return node.family() + count_octants(node.grey & below);
  }
  /// Returns the record at a link; null if its page is missing or has no such record there.
  ///
  /// leaf  whether the parent says that it is a leaf; else it is a node
  const std::byte* record(MaskLink link, bool leaf, TraversalStats& work) {
    switch_to(links_.page(link), work);
    const std::uint32_t at = links_.slot(link);
    return frame_ && holds(at, leaf) ? slot(at) : nullptr;
  }

  /// Switches to the page of a link, which slot() then refers to. Returns false if it is missing.
  bool switch_to_page_of(MaskLink link, TraversalStats& work) {
    switch_to(links_.page(link), work);
    return frame_ != nullptr;
  }
  std::uint32_t slot_of(MaskLink link) const { return links_.slot(link); }
  /// Whether `slots` slots from a link on are within its page.
  bool fits_in_page(MaskLink link, unsigned slots) const {
    return links_.slot(link) + slots <= links_.slots();
  }
  /// Returns the link to a slot of the last record's page.
  MaskLink link_to(std::uint32_t slot) const { return links_.make(page_, slot); }

  const std::byte* slot(std::uint32_t number) const { return frame_ + number * kMaskSlotBytes; }

 private:
  static constexpr std::uint32_t kNoPage = ~std::uint32_t{0};

  bool holds(std::uint32_t at, bool leaf) const {
    return at >= header().first_record_slot &&
           at < std::uint32_t{header().first_record_slot} + header().record_count &&
           is_mask_node(frame_, at) != leaf;
  }
  const MaskHeader& header() const { return *reinterpret_cast<const MaskHeader*>(frame_); }
  void switch_to(std::uint32_t page, TraversalStats& work) {
    if (page == page_) return;
    ++work.page_switches;
    page_ = page;
    frame_ = page < page_count_ ? pages_.page(pages_.context, first_page_ + page) : nullptr;
  }

  const MaskLinkFormat links_;
  const std::uint32_t first_page_;
  const std::uint32_t page_count_;
  const PageReader& pages_;
  std::uint32_t page_ = kNoPage;
  const std::byte* frame_ = nullptr;
};

}  // namespace planetree::octree
