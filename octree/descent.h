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

  /// No triangle offered so far is truly nearer than this: one of a greater
  /// value may be, if its value is less certain.
  double lower() const { return lower_; }

  /// Evaluates a triangle; keeps it if (value, index) is less.
  void offer(const Triangle& corners, std::uint64_t index) {
    const auto [squared, error] = triangle_value(query_, corners);
    lower_ = std::min(lower_, std::sqrt(squared) - error);
    if (squared > squared_ || (squared == squared_ && index >= triangle_)) return;
    if (std::sqrt(squared) > farthest_) return;
    const bool nearer = squared < squared_;
    squared_ = squared;
    triangle_ = index;
    corners_ = corners;
    if (nearer) refresh();
  }

 private:
  void refresh() {
    reach_ = std::min(std::sqrt(squared_), farthest_);
    exact_threshold_ = prune_threshold(wide_, reach_);
    threshold_ = exact_threshold_;
    // While nothing is found there is nothing that an error could be allowed of.
    if (!found()) return;
    // The last 2^-40 pays for the rounding of both ends of the interval.
    const double wanted = limits_.max_error - (reach_ + limits_.max_error) * 0x1p-40;
    if (limits_.max_error > 0 && wanted > 0)
      threshold_ = std::min(threshold_, prune_threshold(wide_, std::max(0.0, reach_ - wanted)));
  }

  Point query_;
  FloatQuery wide_;
  NearestLimits limits_;
  // max_distance and what a value near it may err: no corner is farther away
  // than that and a diagonal of the model, which is below 4 (see
  // octree/triangle_distance.cpp for the factor).
  double farthest_ = limits_.max_distance + 0x1p-40 * (limits_.max_distance + 4);
  double squared_ = std::numeric_limits<double>::infinity();
  double lower_ = std::numeric_limits<double>::infinity();
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

/// Children still to visit: a group for each node on the way down, the last
/// on top. A group is not sorted, because most are dropped whole once the first
/// block has been read. Depth and fan-out bound its size.
class Frontier {
 public:
  bool has_room() const { return size_ + kFanOut <= kMaxEntries && group_count_ < kMaxGroups; }

  void open_group() { groups_[group_count_++] = static_cast<std::uint16_t>(size_); }
  /// Adds to the group opened last.
  void push(FrontierEntry entry) { entries_[size_++] = entry; }

  /// Takes the nearest child of the last group. Groups with none within
  /// `threshold` are dropped; `dropped` becomes the least bound of such, if
  /// less. False when nothing is left.
  bool pop(float threshold, FrontierEntry& entry, float& dropped) {
    for (; group_count_ > 0; --group_count_) {
      const std::size_t begin = groups_[group_count_ - 1];
      if (begin == size_) continue;
      std::size_t nearest = begin;
      for (std::size_t i = begin + 1; i < size_; ++i)
        if (entries_[i].nearer_than(entries_[nearest])) nearest = i;
      entry = entries_[nearest];
      if (entry.bound() <= threshold) {
        entries_[nearest] = entries_[--size_];
        return true;
      }
      dropped = std::min(dropped, entry.bound());
      size_ = begin;
    }
    return false;
  }

 private:
  static constexpr std::size_t kMaxGroups = kMaxHeight + 1;
  static constexpr std::size_t kMaxEntries = (kFanOut - 1) * kMaxHeight + 2 * kFanOut;
  std::size_t size_ = 0;
  std::size_t group_count_ = 0;
  std::uint16_t groups_[kMaxGroups];
  FrontierEntry entries_[kMaxEntries];
};

}  // namespace planetree::octree
