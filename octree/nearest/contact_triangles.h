#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

#include "octree/geometry/triangle_distance.h"
#include "octree/nearest/near_triangles.h"

namespace planetree::octree {

/// The triangles near a query, in fixed memory, in the order of (value, index) and joined where
/// they share corners. Lengths are in the model frame.
///
/// The triangles may be more than fit. Then they come in rounds: each round adds the next ones in
/// the order and forgets those that no later one can touch.
///
/// Use: begin(); in each round near_triangles() with this as its sink, join(), forget_before().
class ContactTriangles final : public NearTriangleSink {
 public:
  static constexpr std::size_t kMax = 512;  ///< triangles kept at once
  /// Triangles that may be left of earlier rounds, so that a round gets on.
  static constexpr std::size_t kMaxEarlier = kMax - kMax / 4;

  struct Entry {
    Triangle corners;
    double squared;   ///< squared distance, as computed
    double distance;  ///< its root
    double error;     ///< bound on the error of `distance`
    std::uint64_t index;
    /// Bit k: the nearest point is on the face, or on an edge or vertex, that corner k belongs to.
    unsigned feature;
  };

  /// Starts with no triangle.
  ///
  /// radius  distance within which triangles are wanted
  void begin(double radius);
  /// Starts a round. The triangles of earlier rounds are not taken again.
  void begin_round();

  double reach() const noexcept override;
  void take(const TriangleResult& result, const Triangle& corners,
            std::uint64_t index) noexcept override;

  /// Sorts the triangles of a round and joins those that share corners.
  void join();
  /// Distance within which every triangle that was found is kept or forgotten; infinity if all are.
  double known_within() const;
  /// Forgets the triangles that do not reach as far as `distance`. Returns false if the others are
  /// too many for another round.
  bool forget_before(const Point& query, double distance);

  std::size_t count() const { return count_; }
  /// Returns the entry that is `rank`-th by (value, index).
  const Entry& ranked(std::size_t rank) const { return entries_[order_[rank]]; }
  std::size_t rank_of(std::size_t entry) const { return rank_[entry]; }
  std::size_t entry_of(std::size_t rank) const { return order_[rank]; }
  const Entry& entry(std::size_t entry) const { return entries_[entry]; }
  /// Lower bound on the true distance of every triangle that was found and is not before `rank`.
  double lower_from(std::size_t rank) const;

  /// Corners are numbered 3 * entry + k. Returns the next corner with the same coordinates, after
  /// the last one the first.
  std::size_t next_at_vertex(std::size_t corner) const { return next_[corner]; }
  const Point& corner(std::size_t corner) const { return entries_[corner / 3].corners[corner % 3]; }

 private:
  using Position = std::pair<double, std::uint64_t>;  // (value, index)

  bool is_before(std::size_t left, std::size_t right) const {
    return position(entries_[left]) < position(entries_[right]);
  }
  static Position position(const Entry& entry) { return {entry.squared, entry.index}; }
  bool is_full() const { return count_ == kMax; }
  std::span<std::uint16_t> new_ones() {
    return std::span(order_).subspan(earlier_, count_ - earlier_);
  }
  void link_vertices();

  static constexpr Position kNone{-1, 0};

  double radius_ = 0;
  std::size_t count_ = 0;
  std::size_t earlier_ = 0;     // entries of earlier rounds: the first of order_
  Position last_ = kNone;       // of earlier rounds, the last triangle in the order
  double lower_of_others_ = 0;  // least lower bound of those found and not kept in this round
  std::array<Entry, kMax> entries_;
  // Entries by rank. During a round those that are new are a heap, the last one first.
  std::array<std::uint16_t, kMax> order_;
  std::array<std::uint16_t, kMax> rank_;
  std::array<std::uint16_t, 3 * kMax> next_;
};

}  // namespace planetree::octree
