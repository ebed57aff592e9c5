#include "octree/builder/mask/block_lister.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <utility>

#include "octree/builder/mask/octant_overlap.h"
#include "octree/geometry/strict_math.h"
#include "octree/page/block_table.h"
#include "octree/traversal/overlap.h"
#include "octree/traversal/tree_walk.h"

namespace planetree::octree {
namespace {

/// Maximum number of nodes and blocks to visit for a cell. Cells of ordinary models take at most a
/// quarter of it, those among needles thousands: the boxes of needles meet nearly all cells.
constexpr std::uint64_t kMaxVisits = 256;

/// Finds the numbers of blocks in their pages.
class BlockNumbers {
 public:
  BlockNumbers(const TreeInfo& tree, const PageReader& pages)
      : page_bytes_(tree.page_bytes), links_(page_bytes_, tree.shape.links), pages_(pages) {}

  /// Returns the numbered link for the link of a block; none if its page is not available.
  std::optional<std::uint32_t> numbered(std::uint32_t link) const {
    if (links_.target() == LinkTarget::kNumber) return link;
    const std::uint32_t page = links_.page(link);
    const std::byte* const frame = pages_.page(pages_.context, page);
    if (!frame) return std::nullopt;
    const std::optional<std::uint16_t> number = BlockTable(frame).number_at(links_.record(link));
    if (!number) return std::nullopt;
    return LinkFormat::numbered(page_bytes_).make_block({page, *number});
  }

 private:
  const std::uint32_t page_bytes_;
  const LinkFormat links_;
  const PageReader& pages_;
};

/// The blocks near a cell, and the octants of the cell that they touch.
class NearBlocks {
 public:
  NearBlocks(const ClippedGrid& grid, const GridCell& cell)
      : lower_(grid.lower(cell)),
        upper_(grid.upper(cell)),
        codes_(lower_, grid.middle(cell), upper_),
        overlap_(lower_, grid.middle(cell), upper_) {}

  const Point& lower() const { return lower_; }
  const Point& upper() const { return upper_; }

  void look_at(const BlockView& block, std::uint32_t link) {
    if (count_ == kCapacity) drop_untouched();
    if (too_many()) return;
    const OctantCodes::NearOctants hits = codes_.near_octants(block);
    found_[count_] = {link, static_cast<std::uint8_t>(hits.with_vertex)};
    for (unsigned i = 0; i < block.triangle_count(); ++i) {
      const unsigned near = hits.by_box[i] & ~hits.with_vertex;
      if (near == 0) continue;
      if (overlap_.full()) settle();
      overlap_.add(block.triangle(i), near, count_);
    }
    ++count_;
  }

  // Whether more than kMaxListed blocks touch the cell for certain.
  bool too_many() const { return certain_ > kMaxListed; }

  BlockLister::Outcome list(const BlockNumbers& numbers, MaskBlocks& blocks) {
    drop_untouched();
    if (too_many()) return BlockLister::Outcome::kTooMany;
    std::sort(found_.begin(), found_.begin() + count_);
    blocks.count = static_cast<std::uint8_t>(count_);
    for (unsigned i = 0; i < count_; ++i) {
      const std::optional<std::uint32_t> link = numbers.numbered(found_[i].first);
      if (!link) return BlockLister::Outcome::kLost;
      blocks.links[i] = *link;
      blocks.octants[i] = found_[i].second;
    }
    return BlockLister::Outcome::kListed;
  }

 private:
  static constexpr unsigned kCapacity = 4 * kMaxListed;

  void settle() {
    const OctantOverlap::TouchedOctants touched_octants = overlap_.take();
    for (unsigned k = 0; k < touched_octants.count; ++k)
      found_[touched_octants.indices[k]].second |= touched_octants.octants[k];
  }
  void drop_untouched() {
    settle();
    const auto end = found_.begin() + count_;
    const auto untouched = [](const auto& block) { return block.second == 0; };
    count_ = static_cast<unsigned>(std::remove_if(found_.begin(), end, untouched) - found_.begin());
    certain_ = count_;
  }

  const Point lower_, upper_;
  const OctantCodes codes_;
  OctantOverlap overlap_;  // indices are those in found_
  std::array<std::pair<std::uint32_t, std::uint8_t>, kCapacity> found_;  // links, octants
  unsigned count_ = 0;
  unsigned certain_ = 0;  // found blocks that touch the cell, when they were last looked at
};

}  // namespace

BlockLister::Outcome BlockLister::list(const GridCell& cell, const PageReader& pages,
                                       MaskBlocks& blocks) const {
  NearBlocks near(grid_, cell);
  TraversalStats work;
  const auto walk = [&](const TreeInfo& tree) {
    return BoxWalk(tree, near.lower(), near.upper(), pages, work)
        .run_while(
            kMaxVisits,
            [&](const BlockView& block, std::uint32_t link) { near.look_at(block, link); },
            [&near] { return !near.too_many(); });
  };
  const bool complete = walk(tree_) && (!tree_.caps || walk(*tree_.caps));
  if (near.too_many() || work.nodes + work.blocks >= kMaxVisits) return Outcome::kTooMany;
  if (!complete) return Outcome::kLost;
  return near.list(BlockNumbers(tree_, pages), blocks);
}

}  // namespace planetree::octree
