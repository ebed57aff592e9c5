#pragma once

#include <algorithm>
#include <cstdint>

namespace planetree::octree {

/// A query's work and its limit, in units. A unit takes at most 2,000 instructions. What takes more
/// is charged several units.
///
/// Every loop over the data of a file charges its steps before it takes them, so that the work
/// never exceeds the limit.
class WorkLimit {
 public:
  /// A limit that no query reaches.
  static constexpr std::uint64_t kNone = std::uint64_t{1} << 62;

  /// units     work so far; must outlive this. Others may add to it too.
  /// max_work  units that may be added to it from now on
  WorkLimit(std::uint64_t& units, std::uint64_t max_work)
      : units_(units), end_(units + std::min(max_work, kNone)) {}

  bool spent() const { return units_ >= end_; }
  /// Whether a step was refused.
  bool exceeded() const { return exceeded_; }
  std::uint64_t left() const { return spent() ? 0 : end_ - units_; }

  /// Charges some units. Returns false if fewer are left; all then count as spent.
  bool take(std::uint64_t units = 1) {
    if (try_take(units)) return true;
    units_ = std::max(units_, end_);
    return false;
  }
  /// Charges what is left, but no more than `units`: for a few steps that no limit may refuse.
  void take_some(std::uint64_t units) { units_ += std::min(units, left()); }
  /// As take(), but leaves what is left for steps that take less.
  bool try_take(std::uint64_t units) {
    const std::uint64_t then = units_ + units;
    if (then > end_) [[unlikely]] {
      exceeded_ = true;
      return false;
    }
    units_ = then;
    return true;
  }

 private:
  std::uint64_t& units_;
  const std::uint64_t end_;
  bool exceeded_ = false;
};

/// The share of the work of a traversal that visits at most a number of records. Keeps its own
/// count, so that a visit costs one subtraction, and charges the limit at its end.
class TraversalWork {
 public:
  TraversalWork(WorkLimit& limit, std::uint64_t max_visits)
      : limit_(limit),
        visits_(std::min(limit.left(), max_visits)),
        other_(limit.left() - visits_),
        before_(limit.left()) {}
  ~TraversalWork() { limit_.take_some(before_ - visits_ - other_); }
  TraversalWork(const TraversalWork&) = delete;
  TraversalWork& operator=(const TraversalWork&) = delete;

  /// Charges a visit. Returns false if none is left.
  bool visit() {
    if (visits_ == 0) return false;
    --visits_;
    return true;
  }
  /// Charges units of other steps. Returns false if fewer are left.
  bool take(std::uint64_t units) {
    if (units <= other_) [[likely]] {
      other_ -= units;
      return true;
    }
    return take_of_visits(units);
  }

 private:
  [[gnu::noinline]] bool take_of_visits(std::uint64_t units) {
    if (units > other_ + visits_) return false;
    visits_ -= units - other_;
    other_ = 0;
    return true;
  }

  WorkLimit& limit_;
  std::uint64_t visits_;  // units for visits
  std::uint64_t other_;   // units that visits do not need
  const std::uint64_t before_;
};

/// Units of the steps that take more than one besides the visit, or of several that take one
/// together. bench/work_bench.cpp counts their instructions.
struct WorkUnits {
  static constexpr unsigned kNearBlock = 4;    ///< distances of a block's triangles in double
  static constexpr unsigned kNearbyList = 16;  ///< distances of the triangles of a coherence cache
  static constexpr unsigned kBlockAngles = 8;  ///< triangles of a block_share(), in a unit
  static constexpr unsigned kSolidAngles =
      2;  ///< solid angles that block_share() leaves out, in a unit
  static constexpr unsigned kBallStep = 1;         ///< distance of one triangle from a moving ball
  static constexpr unsigned kDescription = 40;     ///< nearest point and normal of one triangle
  static constexpr unsigned kFlatFace = 24;        ///< distance from a face too flat for double
  static constexpr unsigned kMoments = 2;          ///< shares of a node's children
  static constexpr unsigned kExactCrossing = 2;    ///< crossing of a triangle, but for exact signs
  static constexpr unsigned kThinNormal = 8;       ///< normal of a face too thin for double
  static constexpr unsigned kSmallSign = 1;        ///< exact sign in 128 bits
  static constexpr unsigned kMediumSign = 6;       ///< in 384 bits
  static constexpr unsigned kLargeSign = 100;      ///< in 4160 bits
  static constexpr unsigned kQuadAngle = 64;       ///< solid angle in 113 bits
  static constexpr unsigned kWidestAngle = 16000;  ///< in 4096 bits
  static constexpr unsigned kWideHeight = 32;      ///< height over a face in 113 bits
  static constexpr unsigned kWideCornerHeight = 64;  ///< the same, times the angle at a corner
  static constexpr unsigned kParentSearch = 4;  ///< search of a page for the parent of a record
  static constexpr unsigned kBallBlock =
      4;  ///< distances of a block's triangles from a ball's centre
  static constexpr unsigned kBoxOverlap = 2;  ///< a triangle against a box, but for exact signs
  static constexpr unsigned kContactTriangles = 2;  ///< triangles sorted and joined, in a unit
  static constexpr unsigned kContactSteps = 16;     ///< steps from one to the next, in a unit
};

}  // namespace planetree::octree
