#include "octree/builder/tree/page_numbers.h"

#include <algorithm>
#include <tuple>

namespace planetree::octree {
namespace {

// Parents come before children: they have a larger cell, are in the top tree, or come earlier in
// their chunk.
auto rank(const NumberedPage& page) {
  const std::uint64_t chunk_rank =
      page.chunk == NumberedPage::kTopTree ? 0 : page.chunk + std::uint64_t{1};
  return std::tuple(page.octcode, chunk_rank, page.index);
}

}  // namespace

PageNumbers::PageNumbers(const TopTree& top_tree, const std::vector<BuiltChunk>& chunks,
                         std::uint32_t page_bytes, std::uint32_t first_page)
    : links_(LinkFormat::numbered(page_bytes)),
      first_page_(first_page),
      of_top_tree_(top_tree.plan.pages.size()),
      of_chunk_(chunks.size()) {
  for (std::uint32_t i = 0; i < top_tree.plan.pages.size(); ++i)
    pages_.push_back({top_tree.plan.pages[i].octcode, 0, NumberedPage::kTopTree, i});
  for (std::uint32_t chunk = 0; chunk < chunks.size(); ++chunk) {
    of_chunk_[chunk].resize(chunks[chunk].pages.size());
    for (std::uint32_t i = 0; i < chunks[chunk].pages.size(); ++i)
      pages_.push_back({chunks[chunk].pages[i].octcode, 0, chunk, i});
  }
  std::sort(pages_.begin(), pages_.end(),
            [](const NumberedPage& a, const NumberedPage& b) { return rank(a) < rank(b); });
  for (std::uint32_t number = 0; number < pages_.size(); ++number) {
    NumberedPage& page = pages_[number];
    if (number > 0 && pages_[number - 1].octcode == page.octcode)
      page.ordinal = pages_[number - 1].ordinal + 1;
    auto& numbers = page.chunk == NumberedPage::kTopTree ? of_top_tree_ : of_chunk_[page.chunk];
    numbers[page.index] = first_page + number;
  }
}

Result<void> PageNumbers::check() const {
  if (first_page_ + std::uint64_t{pages_.size()} <= links_.max_pages()) return {};
  return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                    "%zu pages, more than links can address; build with a larger page size",
                    first_page_ + pages_.size());
}

}  // namespace planetree::octree
