#include "tools/check/mask_walk.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <optional>
#include <utility>
#include <vector>

namespace planetree::tools {

using octree::GridCell;
using octree::MaskNode;

/// The current page, and the cells of its records as they become known.
class MaskWalk::Page {
 public:
  Page(const std::byte* frame, std::uint32_t page_number)
      : number(page_number), frame_(frame), cells_(header().record_count) {}

  const octree::MaskHeader& header() const {
    return *reinterpret_cast<const octree::MaskHeader*>(frame_);
  }
  std::uint32_t record_count() const { return header().record_count; }
  const std::byte* slot(std::uint32_t at) const { return frame_ + at * octree::kMaskSlotBytes; }
  const std::byte* record(std::uint32_t at) const { return slot(header().first_record_slot + at); }
  bool is_node(std::uint32_t at) const {
    return octree::is_mask_node(frame_, header().first_record_slot + at);
  }
  /// The cell of a record, once known.
  std::optional<GridCell>& cell(std::uint32_t at) { return cells_[at]; }

  const std::uint32_t number;

 private:
  const std::byte* frame_;
  std::vector<std::optional<GridCell>> cells_;
};

MaskWalk::MaskWalk(FileParts& parts, Visitor visit, Reporter report)
    : parts_(parts),
      links_(parts.header()->page_bytes),
      visit_(std::move(visit)),
      report_(std::move(report)) {}

void MaskWalk::skip_page(std::uint32_t page) {
  complete_ = false;
  pending_.finish_page(page - parts_.first_mask_page(), [](const auto&, const auto&) {});
}

void MaskWalk::add(std::uint32_t number) {
  Page page(parts_.frame_bytes(), number);
  if (number == parts_.first_mask_page()) {
    page.cell(0) = GridCell{};
    if (page.header().root_count != 1)
      report_({IssueCode::kPageStructure, number, Error::kNowhere,
               "the mask's first page does not have exactly one root; build the file again"});
  } else {
    take_roots(page);
  }
  visit_records(page);
  pending_.finish_page(number - parts_.first_mask_page(), [&](const auto& target, const auto&) {
    report_(
        {IssueCode::kLinkTarget, number, Error::kNowhere,
         fmt::format("a link leads to record {} of the mask page, where no family with the kinds "
                     "that its node states begins",
                     target.record)});
  });
}

// Takes the families that earlier pages link to. They lie one after the other at the front.
void MaskWalk::take_roots(Page& page) {
  const std::uint32_t within = page.number - parts_.first_mask_page();
  const std::uint32_t end = page.header().root_count;
  std::uint64_t least = ~std::uint64_t{0};  // octcode of the nodes
  bool are_known = true;
  for (std::uint32_t first = 0; first < end;) {
    const std::optional<FamilyParent> parent = pending_.take({within, first, false});
    if (!parent) {
      if (complete_)
        report_({IssueCode::kSubtreeUnlinked, page.number, Error::kNowhere,
                 fmt::format("no link leads to the family at record {} of the mask page", first)});
      are_known = false;
      ++first;
      continue;
    }
    least = std::min(least, parent->cell.octcode());
    const auto members = static_cast<unsigned>(std::popcount(parent->node.grey));
    if (members > end - first)
      report_({IssueCode::kLinkTarget, page.number, Error::kNowhere,
               fmt::format("the family at record {} of the mask page has fewer members than its "
                           "node states",
                           first)});
    else
      assign_cells(page, parent->node, parent->cell, first);
    first += members;
  }
  if (are_known && parts_.entries()[page.number].octcode != least)
    report_({IssueCode::kPageStructure, page.number, Error::kNowhere,
             "the page's octcode is not the least of the nodes of its first families; build the "
             "file again"});
}

void MaskWalk::assign_cells(Page& page, const MaskNode& node, const GridCell& cell,
                            std::uint32_t first) {
  std::uint32_t member = first;
  for (unsigned octant = 0; octant < 8; ++octant) {
    if (!node.is_grey(octant)) continue;
    if (page.is_node(member) == node.is_leaf(octant))
      report_(
          {IssueCode::kLinkTarget, page.number, Error::kNowhere,
           fmt::format("record {} of the mask page is not of the kind its node states", member)});
    else
      page.cell(member) = cell.child(octant);
    ++member;
  }
}

void MaskWalk::visit_records(Page& page) {
  for (std::uint32_t number = 0; number < page.record_count(); ++number)
    if (const std::optional<GridCell> cell = page.cell(number)) visit_record(page, number, *cell);
}

void MaskWalk::visit_record(Page& page, std::uint32_t number, const GridCell& cell) {
  GreyCell grey;
  grey.page = page.number;
  grey.cell = cell;
  const std::byte* record = page.record(number);
  if (!page.is_node(number)) {
    const auto& corners = *reinterpret_cast<const octree::MaskCorners*>(record);
    if (octree::is_special(corners)) {
      grey.special = reinterpret_cast<const octree::MaskSpecial*>(record);
      grey.planes = reinterpret_cast<const double*>(page.slot(grey.special->plane_slot));
    } else if (octree::is_listed(corners)) {
      grey.listed = reinterpret_cast<const octree::MaskListed*>(record);
      octree::copy_list(page.slot(0), *grey.listed, grey.blocks);
    } else {
      grey.corners = &corners;
    }
    return visit_(grey);
  }
  grey.node = reinterpret_cast<const MaskNode*>(record);
  visit_(grey);
  if (grey.node->grey == 0) return;
  if (cell.level == octree::kLevels)
    return report_({IssueCode::kPageStructure, page.number, Error::kNowhere,
                    "a cell of the mask is divided below the finest level"});
  const octree::MaskLink family = grey.node->family();
  const std::uint32_t to = links_.page(family);
  // As in any page of the mask.
  const std::uint32_t first = links_.slot(family) - page.header().first_record_slot;
  if (cell.level == 0 && to + parts_.first_mask_page() != page.number)
    report_({IssueCode::kPageStructure, page.number, Error::kNowhere,
             "the family of the mask's root is in another page; build the file again"});
  if (to + parts_.first_mask_page() == page.number)
    assign_cells(page, *grey.node, cell, first);
  else if (!pending_.add({to, first, false}, {cell, *grey.node}))
    report_({IssueCode::kLinkTwice, page.number, Error::kNowhere,
             fmt::format("a second link leads to record {} of mask page {}", first, to)});
}

}  // namespace planetree::tools
