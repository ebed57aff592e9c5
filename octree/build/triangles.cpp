#include "octree/build/triangles.h"

#include <algorithm>

#include "octree/strict_math.h"

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
  struct Place {
    storage::SpillKey key;
    std::uint32_t position;
  };
  std::vector<Place> order(size());
  for (std::uint32_t i = 0; i < size(); ++i) order[i] = {key(i), i};
  const auto precedes = [](const Place& a, const Place& b) { return a.key < b.key; };
  if (std::is_sorted(order.begin(), order.end(), precedes)) return;
  std::sort(order.begin(), order.end(), precedes);
  std::vector<std::byte> sorted(records_.size());
  for (std::uint32_t i = 0; i < size(); ++i)
    std::memcpy(sorted.data() + i * record_bytes(), at(order[i].position), record_bytes());
  records_ = std::move(sorted);
}

}  // namespace planetree::octree
