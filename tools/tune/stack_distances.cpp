#include "tools/tune/stack_distances.h"

#include <algorithm>

namespace planetree::tools {
namespace {

/// Counts marked places in a line, by a Fenwick tree over their sums.
class MarkedPlaces {
 public:
  explicit MarkedPlaces(std::size_t places) : sums_(places + 1, 0) {}

  std::size_t places() const { return sums_.size() - 1; }
  void add(std::size_t place, std::uint32_t value) {
    for (std::size_t at = place + 1; at < sums_.size(); at += at & (~at + 1)) sums_[at] += value;
  }
  /// Marks before a place.
  std::uint32_t before(std::size_t place) const {
    std::uint32_t sum = 0;
    for (std::size_t at = place; at > 0; at &= at - 1) sum += sums_[at];
    return sum;
  }

 private:
  std::vector<std::uint32_t> sums_;
};

/// The stack of LRU as a line of places: each page has a mark at the place of its last lookup.
/// Once the places are used up, the marks move together. There are some times as many places as
/// pages, so that this is seldom, and the tree stays in the processor's cache.
class LruStack {
 public:
  static constexpr std::uint32_t kAbsent = ~std::uint32_t{0};

  explicit LruStack(std::size_t pages)
      : marks_(std::max<std::size_t>(kMinPlaces, 4 * pages)),
        page_at_(marks_.places(), kAbsent),
        place_of_(pages, kAbsent) {}

  /// Moves a page to the top. Returns its distance from there, at least 1; 0 if it was not in the
  /// stack.
  std::uint32_t look_up(std::uint32_t page) {
    std::uint32_t& place = place_of_[page];
    if (place != kAbsent && place + 1 == next_) return 1;
    if (next_ == marks_.places()) move_together();
    std::uint32_t distance = 0;
    if (place != kAbsent) {
      distance = depth_ - marks_.before(place);
      marks_.add(place, ~std::uint32_t{0});  // minus one
      page_at_[place] = kAbsent;
    } else {
      ++depth_;
    }
    place = next_++;
    page_at_[place] = page;
    marks_.add(place, 1);
    return distance;
  }

 private:
  static constexpr std::size_t kMinPlaces = 1024;

  void move_together() {
    std::uint32_t to = 0;
    for (std::uint32_t from = 0; from < next_; ++from) {
      const std::uint32_t page = page_at_[from];
      if (page == kAbsent) continue;
      page_at_[to] = page;
      place_of_[page] = to++;
    }
    std::fill(page_at_.begin() + to, page_at_.end(), kAbsent);
    next_ = to;
    marks_ = MarkedPlaces(marks_.places());
    for (std::uint32_t place = 0; place < to; ++place) marks_.add(place, 1);
  }

  MarkedPlaces marks_;
  std::vector<std::uint32_t> page_at_;   // by place
  std::vector<std::uint32_t> place_of_;  // by page
  std::uint32_t next_ = 0;               // the first unused place
  std::uint32_t depth_ = 0;              // pages in the stack
};

/// Counts of distances as misses by number of frames.
std::vector<std::uint64_t> misses_of(const std::vector<std::uint64_t>& counts,
                                     std::uint64_t compulsory) {
  std::vector<std::uint64_t> misses(counts.size());
  std::uint64_t sum = compulsory;
  for (std::size_t distance = counts.size(); distance-- > 0;) {
    misses[distance] = sum;
    sum += counts[distance];
  }
  return misses;
}

}  // namespace

StackDistances StackDistances::of(const References& references) {
  LruStack stack(references.pages().size());
  std::vector<std::uint64_t> counts(references.pages().size() + 1, 0);
  std::uint64_t compulsory = 0;
  const auto lookups = references.stored();
  for (std::size_t i = 0; i < lookups.size(); ++i) {
    const std::uint32_t distance = stack.look_up(lookups[i]);
    if (i < references.opening()) continue;
    (distance == 0 ? compulsory : counts[distance]) += 1;
  }
  StackDistances distances;
  distances.misses_ = misses_of(counts, compulsory);
  return distances;
}

}  // namespace planetree::tools
