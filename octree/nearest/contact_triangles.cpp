#include "octree/nearest/contact_triangles.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/strict_math.h"

namespace planetree::octree {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::uint16_t kEmpty = 0xFFFF;

// Equal points have equal hashes: 0 and -0 are equal.
std::uint64_t hash_of(const Point& point) {
  std::uint64_t hash = 0;
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    hash = (hash ^ std::bit_cast<std::uint64_t>(point[axis] + 0.0)) * 0x9E3779B97F4A7C15;
  return hash ^ hash >> 32;
}

unsigned feature_of(const NearestOnTriangle& nearest) {
  unsigned feature = 0;
  for (unsigned k = 0; k < 3; ++k) feature |= (nearest.barycentric[k] > 0 ? 1U : 0U) << k;
  return feature;
}

double farthest_corner(const Point& query, const Triangle& triangle) {
  double farthest2 = 0;
  for (const Point& corner : triangle)
    farthest2 = std::max(farthest2, (corner - query).squaredNorm());
  return std::sqrt(farthest2);
}

}  // namespace

void ContactTriangles::begin(double radius) {
  radius_ = radius;
  count_ = earlier_ = 0;
  last_ = kNone;
}

void ContactTriangles::begin_round() {
  if (count_ > 0) last_ = std::max(last_, position(ranked(count_ - 1)));
  earlier_ = count_;
  lower_of_others_ = kInfinity;
}

double ContactTriangles::reach() const noexcept {
  return is_full() ? std::min(radius_, entries_[order_[earlier_]].distance) : radius_;
}

void ContactTriangles::take(const TriangleResult& result, const Triangle& corners,
                            std::uint64_t index) noexcept {
  const auto after = [this](std::uint16_t left, std::uint16_t right) {
    return is_before(left, right);
  };
  const double distance = std::sqrt(result.value.squared);
  const Position at(result.value.squared, index);
  if (at <= last_) return;
  const double lower = distance - result.value.error;
  const bool is_wanted = distance <= radius_;
  if (!is_wanted || (is_full() && at > position(entries_[order_[earlier_]]))) {
    lower_of_others_ = std::min(lower_of_others_, lower);
    return;
  }
  auto entry = static_cast<std::uint16_t>(count_);
  if (is_full()) {
    std::pop_heap(new_ones().begin(), new_ones().end(), after);
    entry = order_[--count_];
    const Entry& dropped = entries_[entry];
    lower_of_others_ = std::min(lower_of_others_, dropped.distance - dropped.error);
  }
  NearestOnTriangle nearest;
  locate(corners, result, nearest);
  entries_[entry] = {corners, result.value.squared, distance, result.value.error,
                     index,   feature_of(nearest)};
  order_[count_++] = entry;
  std::push_heap(new_ones().begin(), new_ones().end(), after);
}

void ContactTriangles::join() {
  std::sort_heap(
      new_ones().begin(), new_ones().end(),
      [this](std::uint16_t left, std::uint16_t right) { return is_before(left, right); });
  for (std::size_t rank = 0; rank < count_; ++rank)
    rank_[order_[rank]] = static_cast<std::uint16_t>(rank);
  link_vertices();
}

// Finds equal corners by a hash table, which only this needs.
void ContactTriangles::link_vertices() {
  constexpr std::size_t kSlots = std::bit_ceil(3 * kMax + kMax / 2);
  std::array<std::uint16_t, kSlots> first;
  const std::size_t used = std::min(kSlots, std::bit_ceil(6 * count_ + 1));
  std::fill_n(first.begin(), used, kEmpty);
  for (std::size_t corner_number = 0; corner_number < 3 * count_; ++corner_number) {
    const Point& point = corner(corner_number);
    std::size_t slot = hash_of(point) & (used - 1);
    while (first[slot] != kEmpty && corner(first[slot]) != point) slot = (slot + 1) & (used - 1);
    const auto number = static_cast<std::uint16_t>(corner_number);
    if (first[slot] == kEmpty) {
      first[slot] = next_[number] = number;
    } else {
      next_[number] = next_[first[slot]];
      next_[first[slot]] = number;
    }
  }
}

double ContactTriangles::known_within() const {
  return is_full() ? ranked(count_ - 1).distance : kInfinity;
}

bool ContactTriangles::forget_before(const Point& query, double distance) {
  last_ = std::max(last_, position(ranked(count_ - 1)));
  // Marks the entries to keep, in rank_, and closes the gaps of the order.
  std::size_t kept = 0;
  for (std::size_t rank = 0; rank < count_; ++rank) {
    const std::uint16_t entry = order_[rank];
    if (farthest_corner(query, entries_[entry].corners) < distance) {
      rank_[entry] = kEmpty;
    } else {
      rank_[entry] = static_cast<std::uint16_t>(kept);
      order_[kept++] = entry;
    }
  }
  // Moves the entries to the front.
  std::size_t to = 0;
  for (std::size_t from = 0; from < count_; ++from) {
    if (rank_[from] == kEmpty) continue;
    order_[rank_[from]] = static_cast<std::uint16_t>(to);
    if (to != from) entries_[to] = entries_[from];
    ++to;
  }
  count_ = kept;
  return count_ <= kMaxEarlier;
}

double ContactTriangles::lower_from(std::size_t rank) const {
  double lower = lower_of_others_;
  for (; rank < count_; ++rank) lower = std::min(lower, ranked(rank).distance - ranked(rank).error);
  return lower;
}

}  // namespace planetree::octree
