#include "octree/builder/sort/triangles.h"

#include <algorithm>
#include <cstddef>

#include "octree/geometry/strict_math.h"

namespace planetree::octree {
namespace {

template <class Real>
void store(const Triangle& corners, std::byte* to) {
  Real values[9];
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t axis = 0; axis < 3; ++axis)
      values[3 * k + axis] = static_cast<Real>(corners[k][static_cast<Eigen::Index>(axis)]);
  std::memcpy(to, values, sizeof values);
}

/// Sorts elements, by merging if they are a few sorted runs. False if they were sorted already.
template <class Element, class Precedes>
bool merge_runs(std::vector<Element>& elements, const Precedes& precedes) {
  // Merging is faster than sorting where runs have at least this many elements on average.
  constexpr std::size_t kFewElements = 64;
  const auto first = elements.begin(), last = elements.end();
  std::vector<std::ptrdiff_t> ends;
  for (auto begin = first; begin != last;) {
    begin = std::is_sorted_until(begin, last, precedes);
    ends.push_back(begin - first);
  }
  if (ends.size() <= 1) return false;
  if (ends.size() > elements.size() / kFewElements) {
    std::sort(first, last, precedes);
    return true;
  }
  while (ends.size() > 1) {
    std::vector<std::ptrdiff_t> merged;
    for (std::size_t i = 0; i < ends.size(); i += 2) {
      const std::ptrdiff_t begin = i == 0 ? 0 : ends[i - 1], middle = ends[i];
      const std::ptrdiff_t end = i + 1 < ends.size() ? ends[i + 1] : middle;
      std::inplace_merge(first + begin, first + middle, first + end, precedes);
      merged.push_back(end);
    }
    ends = std::move(merged);
  }
  return true;
}

}  // namespace

void Triangles::set(std::uint32_t position, const storage::SpillKey& key, const Triangle& corners) {
  std::byte* const to = records_.data() + position * record_bytes();
  std::memcpy(to, &key, sizeof key);
  if (float64_)
    store<double>(corners, to + sizeof key);
  else
    store<float>(corners, to + sizeof key);
}

void Triangles::sort() {
  struct SortKey {
    storage::SpillKey key;
    std::uint32_t position;
  };
  std::vector<SortKey> order(size());
  for (std::uint32_t i = 0; i < size(); ++i) order[i] = {key(i), i};
  const auto precedes = [](const SortKey& a, const SortKey& b) {
    return a.key.first != b.key.first ? a.key.first < b.key.first : a.key.second < b.key.second;
  };
  if (!merge_runs(order, precedes)) return;
  std::vector<std::byte> sorted(records_.size());
  for (std::uint32_t i = 0; i < size(); ++i)
    std::memcpy(sorted.data() + i * record_bytes(), at(order[i].position), record_bytes());
  records_ = std::move(sorted);
}

}  // namespace planetree::octree
