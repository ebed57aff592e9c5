#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "octree/block_view.h"
#include "octree/bounds.h"
#include "octree/nearest.h"

namespace planetree::octree {

/// The best triangle of a descent so far and what may be pruned because of it.
class BestTriangle {
 public:
  BestTriangle(const Point& query, const FloatQuery& wide, const NearestLimits& limits)
      : query_(query), wide_(wide), limits_(limits) {
    refresh();
  }

  bool found() const { return triangle_ != kNoTriangle; }
  std::uint64_t triangle() const { return triangle_; }
  const Triangle& corners() const { return corners_; }

  /// Nothing farther than this is of interest.
  double reach() const { return reach_; }
  /// Child bounds above this are not worth a visit.
  float threshold() const { return threshold_; }
  /// Child bounds above this cannot hold the nearest triangle.
  float exact_threshold() const { return exact_threshold_; }

  /// Evaluates a triangle; keeps it if (value, index) is less.
  void offer(const Triangle& corners, std::uint64_t index) {
    const double squared = squared_distance(query_, corners);
    if (squared > squared_ || (squared == squared_ && index >= triangle_)) return;
    if (std::sqrt(squared) > limits_.max_distance) return;
    const bool nearer = squared < squared_;
    squared_ = squared;
    triangle_ = index;
    corners_ = corners;
    if (nearer) refresh();
  }

 private:
  void refresh() {
    reach_ = std::min(std::sqrt(squared_), limits_.max_distance);
    exact_threshold_ = prune_threshold(wide_, reach_);
    threshold_ = exact_threshold_;
    // The last 2^-40 pays for the rounding of both ends of the interval.
    const double wanted = limits_.max_error - (reach_ + limits_.max_error) * 0x1p-40;
    if (limits_.max_error > 0 && wanted > 0)
      threshold_ = std::min(threshold_, prune_threshold(wide_, std::max(0.0, reach_ - wanted)));
  }

  Point query_;
  FloatQuery wide_;
  NearestLimits limits_;
  double squared_ = std::numeric_limits<double>::infinity();
  std::uint64_t triangle_ = kNoTriangle;
  Triangle corners_{Point::Zero(), Point::Zero(), Point::Zero()};
  double reach_ = 0;
  float threshold_ = 0;
  float exact_threshold_ = 0;
};

/// A child to visit: its squared bound and its link in one integer, which
/// orders as the bound does because bounds are not negative. Children of equal
/// bound go by link, so that every run takes the same way.
class FrontierEntry {
 public:
  FrontierEntry() = default;
  FrontierEntry(float bound, std::uint32_t link)
      : key_(std::uint64_t{std::bit_cast<std::uint32_t>(bound)} << 32 | link) {}
  float bound() const { return std::bit_cast<float>(static_cast<std::uint32_t>(key_ >> 32)); }
  std::uint32_t link() const { return static_cast<std::uint32_t>(key_); }
  bool nearer_than(FrontierEntry other) const { return key_ < other.key_; }

 private:
  std::uint64_t key_;
};

/// Children still to visit, the nearest siblings on top. Depth and fan-out
/// bound its size.
class Frontier {
 public:
  bool empty() const { return size_ == 0; }
  bool has_room() const { return size_ + kFanOut <= kCapacity; }
  FrontierEntry pop() { return entries_[--size_]; }
  std::size_t mark() const { return size_; }

  /// Adds a child among those pushed since `mark`, farthest first.
  void push(std::size_t mark, FrontierEntry entry) {
    std::size_t at = size_++;
    for (; at > mark && entries_[at - 1].nearer_than(entry); --at) entries_[at] = entries_[at - 1];
    entries_[at] = entry;
  }

 private:
  static constexpr std::size_t kCapacity = (kFanOut - 1) * kMaxHeight + 2 * kFanOut;
  std::size_t size_ = 0;
  FrontierEntry entries_[kCapacity];
};

}  // namespace planetree::octree
