#include "tools/tune/references.h"

#include <algorithm>
#include <numeric>

namespace planetree::tools {
namespace {

constexpr std::uint64_t mixed(std::uint64_t value) noexcept {
  value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9U;
  value = (value ^ (value >> 27)) * 0x94d049bb133111ebU;
  return value ^ (value >> 31);
}

}  // namespace

void References::add(std::uint32_t file_page) {
  ++lookups_;
  if (file_page == kRootPage) return;
  if (file_page >= numbers_.size()) numbers_.resize(file_page + 1, kNoNumber);
  std::uint32_t& number = numbers_[file_page];
  if (number == kNoNumber) {
    number = static_cast<std::uint32_t>(pages_.size());
    const bool is_upper = file_page < is_upper_.size() && is_upper_[file_page];
    pages_.push_back({file_page, is_upper ? cache::PageTier::kUpper : cache::PageTier::kLower});
  }
  const bool repeats = stored_.size() > opening_ && stored_.back() == number;
  run_ = repeats ? run_ + 1 : 1;
  if (run_ <= kMaxRun) stored_.push_back(number);
}

void References::set_upper(std::uint32_t file_page) {
  if (file_page == kRootPage) root_tier_ = cache::PageTier::kUpper;
  if (file_page >= is_upper_.size()) is_upper_.resize(file_page + 1, false);
  is_upper_[file_page] = true;
  if (const std::uint32_t number = number_of(file_page); number != kNoNumber)
    pages_[number].tier = cache::PageTier::kUpper;
}

void References::end_opening() {
  opening_ = stored_.size();
  opening_pages_ = pages_.size();
  lookups_ = 0;
  run_ = 0;
  query_begins_.clear();
}

References References::sampled(std::uint32_t step, std::uint32_t group) const {
  std::vector<std::uint64_t> counts(pages_.size(), 0);
  for (const std::uint32_t page : stored_) ++counts[page];
  std::vector<std::uint32_t> order(pages_.size());
  std::iota(order.begin(), order.end(), 0U);
  // Pages of as many lookups come in the order of a hash: their order in the file would follow the
  // path.
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    if (counts[a] != counts[b]) return counts[a] > counts[b];
    return mixed(pages_[a].file_page + 1U) < mixed(pages_[b].file_page + 1U);
  });
  std::vector<bool> is_kept(pages_.size(), false);
  for (std::size_t rank = group; rank < order.size(); rank += step) is_kept[order[rank]] = true;
  References sample;
  for (std::size_t i = 0; i < stored_.size(); ++i) {
    if (i == opening_) sample.end_opening();
    if (is_kept[stored_[i]]) sample.add(pages_[stored_[i]].file_page);
  }
  if (opening_ == stored_.size()) sample.end_opening();
  sample.root_tier_ = root_tier_;
  for (const Page& page : pages_)
    if (page.tier == cache::PageTier::kUpper) sample.set_upper(page.file_page);
  return sample;
}

}  // namespace planetree::tools
