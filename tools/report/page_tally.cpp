#include "tools/report/page_tally.h"

#include <algorithm>

namespace planetree::tools {

std::string_view page_kind_name(PageKind kind) {
  constexpr std::string_view kNames[kPageKindCount] = {"distance", "caps", "field", "attributes",
                                                       "mask"};
  return kNames[static_cast<std::size_t>(kind)];
}

PageKind kind_of(const FileParts& parts, std::uint32_t page) {
  if (page < parts.first_cap_page()) return PageKind::kDistance;
  if (page < parts.first_field_page()) return PageKind::kCaps;
  if (page < parts.first_attribute_page()) return PageKind::kField;
  return page < parts.first_mask_page() ? PageKind::kAttributes : PageKind::kMask;
}

void PageTally::add(const PageRow& row) {
  const std::uint64_t pages = parts_->page_count(), page_bytes = parts_->header()->page_bytes;
  const auto kind = static_cast<std::size_t>(kind_of(*parts_, row.number));
  const std::uint64_t windows = std::min<std::uint64_t>(pages, kMaxWindows);
  const std::size_t window = static_cast<std::size_t>(row.number * windows / pages);
  if (windows_.size() <= window) {
    windows_.resize(window + 1);
    windows_.back().first = row.number;
  }
  Window& at = windows_[window];
  at.last = row.number;
  at.stored_bytes += row.entry.stored_bytes;
  at.raw_bytes += row.entry.raw_bytes;
  ++at.pages[kind];
  const std::uint64_t bin = row.entry.stored_bytes * std::uint64_t{kSizes} / page_bytes;
  ++sizes_[std::min<std::uint64_t>(bin, kSizes - 1)][kind];
  if (row.head || row.mask || row.field || row.attributes) return;
  ++at.unreadable;
  ++unreadable_;
}

}  // namespace planetree::tools
