#include "octree/builder/tree/page_numbers.h"

#include <algorithm>
#include <tuple>

namespace planetree::octree {
namespace {

// Parents come before children: of a larger cell, of the crown, or earlier in their patch.
auto rank(const NumberedPage& page) {
  const std::uint64_t owner =
      page.patch == NumberedPage::kCrown ? 0 : page.patch + std::uint64_t{1};
  return std::tuple(page.octcode, owner, page.place);
}

}  // namespace

PageNumbers::PageNumbers(const Crown& crown, const std::vector<BuiltPatch>& patches,
                         std::uint32_t page_bytes)
    : links_(page_bytes), of_crown_(crown.plan.pages.size()), of_patch_(patches.size()) {
  for (std::uint32_t i = 0; i < crown.plan.pages.size(); ++i)
    pages_.push_back({crown.plan.pages[i].octcode, 0, NumberedPage::kCrown, i});
  for (std::uint32_t patch = 0; patch < patches.size(); ++patch) {
    of_patch_[patch].resize(patches[patch].pages.size());
    for (std::uint32_t i = 0; i < patches[patch].pages.size(); ++i)
      pages_.push_back({patches[patch].pages[i].octcode, 0, patch, i});
  }
  std::sort(pages_.begin(), pages_.end(),
            [](const NumberedPage& a, const NumberedPage& b) { return rank(a) < rank(b); });
  for (std::uint32_t number = 0; number < pages_.size(); ++number) {
    NumberedPage& page = pages_[number];
    if (number > 0 && pages_[number - 1].octcode == page.octcode)
      page.ordinal = pages_[number - 1].ordinal + 1;
    auto& numbers = page.patch == NumberedPage::kCrown ? of_crown_ : of_patch_[page.patch];
    numbers[page.place] = number;
  }
}

Result<void> PageNumbers::check() const {
  if (pages_.size() <= links_.max_pages()) return {};
  return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                    "%zu pages, more than links can tell apart; build with a larger page size",
                    pages_.size());
}

std::uint32_t PageNumbers::link(std::uint32_t patch, std::uint32_t link) const {
  return links_.make(LinkFormat::is_leaf(link), of_patch_[patch][links_.page(link)],
                     links_.slot(link));
}

}  // namespace planetree::octree
