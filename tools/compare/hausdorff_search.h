#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "planetree/probe.h"
#include "storage/spill/spill_file.h"
#include "tools/compare/deviation_tally.h"
#include "tools/mesh/mesh_pieces.h"

namespace planetree::tools {

/// How narrow the interval of a greatest distance is to be, and what that may cost.
struct HausdorffGoal {
  std::optional<double> error;  ///< model units; empty: 1 % of the lower end or `least_error`
  double least_error = 0;       ///< model units
  std::uint64_t max_splits = std::numeric_limits<std::uint64_t>::max();

  double error_for(double lower) const {
    return error ? *error : std::max(least_error, 0.01 * lower);
  }
};

/// Finds the greatest distance of all points of triangles from a model, as a certified interval.
///
/// lower  the greatest certified distance of a corner of a triangle or of a part of one
/// upper  the greatest bound of the triangles or their parts
///
/// A bound of a triangle is the least of these, where u is the upper end of a corner's distance:
///
/// - The distance changes by no more than the way. No point of a triangle is farther from the
///   nearest corner than 1/sqrt(3) of the longest edge, nor from a corner than the longer edge
///   there.
/// - The distance from one triangle of the model is convex, so it is greatest at a corner. This
///   holds for each triangle that is among the nearest kNearest of all three corners.
///
/// Triangles whose bounds exceed the lower end by more than the allowed error are split into four
/// at the middles of their edges until none is left, or until the splits are spent. They wait in a
/// temporary file until all corners are known, so that memory does not grow with their number.
class HausdorffSearch {
 public:
  static constexpr std::size_t kNearest = 12;

  /// probe         must outlive this
  /// max_distance  as QueryOptions; where it is exceeded, there is no upper end
  HausdorffSearch(Probe& probe, const HausdorffGoal& goal, double max_distance);

  /// Takes triangles, with the answers for their corners.
  ///
  /// errors  those of temporary files
  Result<void> add(const MeshPiece& piece, std::span<const ClosestPoint> answers);

  /// Number of triangles that wait for refine().
  std::uint64_t waiting() const { return waiting_.size_bytes() / sizeof(Part); }
  /// Splits what waits. The last call.
  ///
  /// progress  called now and then with the number of triangles that are done since the last call
  /// errors    those of temporary files
  Result<void> refine(const std::function<void(std::uint64_t)>& progress);

  /// The interval; complete after refine().
  const HausdorffInterval& interval() const { return interval_; }
  /// Whether the interval is as narrow as the goal says.
  bool is_within_error() const {
    return interval_.upper <= interval_.lower + goal_.error_for(interval_.lower);
  }
  std::uint64_t splits() const { return splits_; }

 private:
  // A corner, what is known of its distance, and the nearest triangle if that is known.
  struct Corner {
    Corner() = default;
    Corner(const Vec3& at, const ClosestPoint& answer)
        : point(at), lower(answer.lower), upper(answer.upper), triangle(answer.triangle) {}
    /// A corner whose distance is certain enough.
    Corner(const Vec3& at, double upper_end) : point(at), lower(upper_end), upper(upper_end) {}

    Vec3 point;
    double lower = 0, upper = 0;
    std::uint64_t triangle = kNoTriangle;
  };
  // A triangle or a part of one.
  struct Part {
    std::array<Vec3, 3> corners;
    std::array<double, 3> upper{};
    double bound = 0;
    bool is_certain = false;  // the corners' intervals are narrow enough to split it
  };
  // A triangle of the model near a corner, with the upper end of its distance.
  using NearTriangle = std::pair<std::uint64_t, double>;
  using NearTriangles = std::vector<NearTriangle>;

  double limit() const { return interval_.lower + goal_.error_for(interval_.lower); }
  Part make_part(const std::array<Corner, 3>& corners) const;
  void retire(const Part& part) { upper_ = std::max(upper_, part.bound); }
  bool can_split(const Part& part) const;
  void refine_all(std::vector<Part>& open);
  void tighten(Part& part);
  const NearTriangles& near_triangles(const Vec3& point);
  void split(std::span<const Part> parts, std::vector<Part>& open);

  Probe& probe_;
  const HausdorffGoal goal_;
  const QueryOptions options_;
  HausdorffInterval interval_;
  double upper_ = 0;  // greatest bound of what is done
  storage::SpillFile waiting_;
  std::uint64_t splits_ = 0;
  std::unordered_map<Vec3, NearTriangles, SamePosition, SamePosition> near_;
};

}  // namespace planetree::tools
