#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "octree/bounds.h"
#include "octree/triangle_rows.h"

namespace planetree::octree {

/// All triangles that reach into a ball, where they are few: queries within it look at no
/// node, block or page at all.
class NearbyTriangles {
 public:
  static constexpr std::size_t kMost = 32;

  /// Forgets what was there.
  void begin(const Point& centre) {
    size_ = 0;
    complete_ = false;
    centre_ = centre;
    extent_ = 0;
  }

  /// False where there is no room for it.
  bool add(const Triangle& corners, std::uint64_t id) {
    if (size_ == kMost) return false;
    for (std::size_t k = 0; k < 3; ++k) {
      const Point from = corners[k] - centre_;
      for (std::size_t axis = 0; axis < 3; ++axis)
        row_[k][axis][size_] = static_cast<float>(from[static_cast<Eigen::Index>(axis)]);
      extent_ = std::max(extent_, round_up(from.norm()));
    }
    exact_.set(size_, corners);
    id_[size_++] = id;
    return true;
  }

  /// All have been added.
  void finish() {
    complete_ = size_ > 0 && extent_ >= kLeastFilterExtent;
    for (std::size_t i = size_; i % kLanes != 0; ++i)
      for (auto& corner : row_)
        for (auto& row : corner) row[i] = row[size_ - 1];
  }

  /// Whether there is a list, and of all.
  bool complete() const { return complete_; }
  std::size_t size() const { return size_; }
  const Point& centre() const { return centre_; }
  /// At least the distance of any corner from the centre; 2^-40 or more.
  float extent() const { return extent_; }
  /// A coordinate of a corner of each, relative to the centre and rounded; the last is
  /// repeated up to the next multiple of eight.
  const float* row(std::size_t corner, std::size_t axis) const { return row_[corner][axis]; }

  Triangle triangle(std::size_t i) const { return exact_.triangle(i); }
  bool has_corner(std::size_t i, const Point& point) const {
    bool found = false;
    for (const auto& corner : exact_.at)
      found = found ||
              (corner[0][i] == point.x() && corner[1][i] == point.y() && corner[2][i] == point.z());
    return found;
  }
  std::uint64_t id(std::size_t i) const { return id_[i]; }

 private:
  static constexpr std::size_t kLanes = 8;

  Point centre_ = Point::Zero();
  std::size_t size_ = 0;
  float extent_ = 0;
  bool complete_ = false;
  alignas(kLanes * sizeof(float)) float row_[3][3][kMost];
  TriangleRows<kMost> exact_;
  std::uint64_t id_[kMost];
};

}  // namespace planetree::octree
