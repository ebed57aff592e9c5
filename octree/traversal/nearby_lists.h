#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "octree/geometry/triangle_distance.h"
#include "octree/page/frame.h"
#include "octree/traversal/bounds.h"

namespace planetree::octree {

/// The subtrees that reach into a ball; the smallest is a block. Queries within the ball start with
/// these instead of the root. Boxes are as decoded from the parent nodes, stored side by side.
class NearbySubtrees {
 public:
  static constexpr std::size_t kMax = 64;

  /// Removes all subtrees.
  void clear() { size_ = 0; }

  /// Returns whether the children of any node fit.
  bool has_capacity() const { return size_ + kFanOut <= kMax; }
  /// Memory for more subtrees while has_capacity(). A vector of kFanOut numbers may be written to
  /// each; add() then adds the first `count` of them.
  float* next_lower(std::size_t axis) { return lower_[axis] + size_; }
  float* next_upper(std::size_t axis) { return upper_[axis] + size_; }
  std::uint32_t* next_link() { return link_ + size_; }
  void add(std::size_t count) { size_ += count; }
  /// Removes a subtree. The last one takes its index.
  void remove(std::size_t at) {
    --size_;
    for (unsigned axis = 0; axis < 3; ++axis) {
      lower_[axis][at] = lower_[axis][size_];
      upper_[axis][at] = upper_[axis][size_];
    }
    link_[at] = link_[size_];
  }

  std::size_t size() const { return size_; }
  bool are_blocks() const { return std::all_of(link_, link_ + size_, LinkFormat::is_leaf); }
  std::uint32_t link(std::size_t i) const { return link_[i]; }
  /// Returns an upper bound on the distance from a query to the surface points of a subtree; see
  /// farthest_in_box().
  double farthest(std::size_t i, const Point& query) const {
    return farthest_in_box(
        {{lower_[0][i], lower_[1][i], lower_[2][i]}, {upper_[0][i], upper_[1][i], upper_[2][i]}},
        query);
  }
  /// Returns a side of each box. Up to the next multiple of sixteen, unspecified numbers follow.
  const float* lower(std::size_t axis) const { return lower_[axis]; }
  const float* upper(std::size_t axis) const { return upper_[axis]; }

 private:
  static constexpr std::size_t kLanes = kMaxBlockTriangles;  // maximum number of lanes in a kernel
  static_assert(kMax % kLanes == 0);

  std::size_t size_ = 0;
  alignas(kSlotBytes) float lower_[3][kMax] = {};
  alignas(kSlotBytes) float upper_[3][kMax] = {};
  std::uint32_t link_[kMax] = {};
};

/// A triangle that reaches into a ball.
struct NearbyTriangle {
  Triangle corners;
  std::uint64_t id;
  double nearest;                ///< lower bound on its distance from the centre
  bool is_height_field = false;  ///< its block is in a height field
};

/// All triangles that reach into a ball, if they are few. Queries within the ball then read no
/// nodes, blocks or pages. Triangles near the centre come first, so that queries near the centre
/// test few.
class NearbyTriangles {
 public:
  static constexpr std::size_t kMax = 192;

  /// Removes all triangles.
  void clear() {
    size_ = 0;
    complete_ = false;
  }

  /// Replaces the list.
  ///
  /// found    all triangles that reach into the ball, at most kMax
  /// nearest  distance of the nearest triangle from `centre`
  /// radius   radius of the ball
  void fill(std::span<const NearbyTriangle> found, const Point& centre, double nearest,
            double radius) {
    centre_ = centre;
    nearest_ = nearest;
    rings_per_length_ = radius > nearest ? kRings / (radius - nearest) : 0;
    extent_ = 0;
    size_ = found.size();
    std::array<std::uint8_t, kMax> ring;
    std::array<std::size_t, kRings + 1> next{};
    for (std::size_t i = 0; i < size_; ++i) {
      ring[i] = static_cast<std::uint8_t>(ring_at(found[i].nearest));
      ++next[ring[i] + 1u];
    }
    for (std::size_t i = 1; i <= kRings; ++i) next[i] += next[i - 1];
    for (std::size_t i = 0; i < kRings; ++i) end_[i] = static_cast<std::uint8_t>(next[i + 1]);
    double extent2 = 0;
    for (std::size_t i = 0; i < size_; ++i)
      extent2 = std::max(extent2, set(next[ring[i]]++, found[i]));
    extent_ = round_up(std::sqrt(extent2));
    for (std::size_t i = size_; i % kLanes != 0; ++i) repeat_last(i);
    complete_ = size_ > 0 && extent_ >= kFilterMinExtent && extent_ <= kFilterMaxExtent;
  }

  /// Returns whether the list holds all triangles of the ball and its extent suffices for float.
  bool complete() const { return complete_; }
  std::size_t size() const { return size_; }
  /// Returns how many triangles at the front to test: the others are farther from the centre than
  /// `distance`.
  std::size_t count_within(double distance) const { return end_[ring_at(distance)]; }
  const Point& centre() const { return centre_; }
  /// Returns an upper bound on the distance of any corner from the centre; 2^-40 or more if
  /// complete().
  float extent() const { return extent_; }
  /// Returns a coordinate of one corner of each triangle, relative to the centre and rounded to
  /// float. The last triangle is repeated up to the next multiple of sixteen.
  const float* row(std::size_t corner, std::size_t axis) const { return row_[corner][axis]; }
  /// Returns the exact corners. The last triangle is repeated in the same way.
  const TriangleRows<kMax>& exact() const { return exact_; }

  Triangle triangle(std::size_t i) const { return exact_.triangle(i); }
  std::uint64_t id(std::size_t i) const { return id_[i]; }
  bool is_height_field(std::size_t i) const { return is_height_field_[i]; }

 private:
  static constexpr std::size_t kLanes = kMaxBlockTriangles;  // maximum number of lanes in a kernel
  static_assert(kMax % kLanes == 0 && kMax <= 255);
  static constexpr std::size_t kRings = 16;

  // Never decreases with the distance, however it is rounded.
  std::size_t ring_at(double distance) const {
    const double ring = (distance - nearest_) * rings_per_length_;
    return ring > 0 ? static_cast<std::size_t>(std::min(ring, kRings - 1.0)) : 0;
  }

  // Returns the greatest squared distance of a corner from the centre.
  double set(std::size_t i, const NearbyTriangle& found) {
    double farthest2 = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Point from = found.corners[k] - centre_;
      for (std::size_t axis = 0; axis < 3; ++axis)
        row_[k][axis][i] = static_cast<float>(from[static_cast<Eigen::Index>(axis)]);
      farthest2 = std::max(farthest2, from.squaredNorm());
    }
    exact_.set(i, found.corners);
    id_[i] = found.id;
    is_height_field_[i] = found.is_height_field;
    return farthest2;
  }

  void repeat_last(std::size_t i) {
    for (auto& corner : row_)
      for (auto& row : corner) row[i] = row[size_ - 1];
    exact_.copy(size_ - 1, i);
  }

  Point centre_ = Point::Zero();
  double nearest_ = 0;
  double rings_per_length_ = 0;
  std::size_t size_ = 0;
  float extent_ = 0;
  bool complete_ = false;
  std::array<std::uint8_t, kRings> end_;  // end of each ring's triangles
  alignas(kLanes * sizeof(float)) float row_[3][3][kMax];
  TriangleRows<kMax> exact_;
  std::uint64_t id_[kMax];
  bool is_height_field_[kMax];
};

}  // namespace planetree::octree
