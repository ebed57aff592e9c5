#include "tools/nearest_word.h"

#include <algorithm>

namespace planetree::tools {
namespace {

/// The least number of letters to leave out, add, replace or swap with the next to make one word of
/// the other.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  // Row i has the distances of the first i letters of a; only three rows are needed.
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before.swap(last);
    last.swap(row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, replaced});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row[b.size()];
}

}  // namespace

std::optional<std::string> nearest_word(std::string_view misspelled,
                                        const std::vector<std::string>& words) {
  constexpr std::size_t kMaxLetters = 64;
  if (misspelled.size() > kMaxLetters) return std::nullopt;
  std::optional<std::string> nearest;
  std::size_t least = std::max<std::size_t>(misspelled.size() / 3, 1) + 1;
  for (const std::string& word : words) {
    const std::size_t distance = edit_distance(misspelled, word);
    if (distance < least) nearest = word;
    least = std::min(least, distance);
  }
  return nearest;
}

}  // namespace planetree::tools
