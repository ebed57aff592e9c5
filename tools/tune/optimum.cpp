#include "tools/tune/optimum.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>

namespace planetree::tools {
namespace {

/// A set of whole numbers below a limit, which finds its greatest. Each level has a bit for each
/// word of the level below that is not 0.
class NumberSet {
 public:
  explicit NumberSet(std::size_t limit) {
    for (std::size_t size = limit; levels_.empty() || size > 1;) {
      size = size / 64 + 1;
      levels_.emplace_back(size, 0);
    }
  }

  bool contains(std::size_t number) const {
    return (levels_[0][number / 64] >> number % 64 & 1) != 0;
  }
  void insert(std::size_t number) {
    for (auto& words : levels_) {
      std::uint64_t& word = words[number / 64];
      const bool was_empty = word == 0;
      word |= std::uint64_t{1} << number % 64;
      if (!was_empty) return;
      number /= 64;
    }
  }
  void erase(std::size_t number) {
    for (auto& words : levels_) {
      std::uint64_t& word = words[number / 64];
      word &= ~(std::uint64_t{1} << number % 64);
      if (word != 0) return;
      number /= 64;
    }
  }
  /// The set must not be empty.
  std::size_t greatest() const {
    std::size_t number = 0;
    for (std::size_t level = levels_.size(); level-- > 0;)
      number =
          64 * number + 63 - static_cast<std::size_t>(std::countl_zero(levels_[level][number]));
    return number;
  }

 private:
  std::vector<std::vector<std::uint64_t>> levels_;
};

/// For each stored lookup the position of the next one of the same page. After a page's last
/// lookup: a number of its own, beyond all positions.
std::vector<std::uint32_t> next_lookups(const References& references) {
  const auto lookups = references.stored();
  std::vector<std::uint32_t> next(lookups.size());
  std::vector<std::uint32_t> next_of(references.pages().size());
  for (std::uint32_t page = 0; page < next_of.size(); ++page)
    next_of[page] = static_cast<std::uint32_t>(lookups.size()) + page;
  for (std::size_t i = lookups.size(); i-- > 0;) {
    next[i] = next_of[lookups[i]];
    next_of[lookups[i]] = static_cast<std::uint32_t>(i);
  }
  return next;
}

/// The set has the position of the next lookup of each resident page.
std::uint64_t misses_in(std::uint32_t frames, const References& references,
                        std::span<const std::uint32_t> next) {
  NumberSet resident(next.size() + references.pages().size());
  std::uint64_t misses = 0;
  std::uint32_t free = frames;
  for (std::size_t i = 0; i < next.size(); ++i) {
    if (resident.contains(i)) {
      resident.erase(i);
    } else {
      misses += i >= references.opening();
      if (free > 0) {
        --free;
      } else {
        resident.erase(resident.greatest());
      }
    }
    resident.insert(next[i]);
  }
  return misses;
}

}  // namespace

std::vector<std::uint64_t> optimum_misses(const References& references,
                                          std::span<const std::uint32_t> frames) {
  const std::vector<std::uint32_t> next = next_lookups(references);
  std::vector<std::uint64_t> misses;
  for (const std::uint32_t count : frames) misses.push_back(misses_in(count - 1, references, next));
  return misses;
}

}  // namespace planetree::tools
