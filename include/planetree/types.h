#pragma once

#include <cstdint>
#include <limits>

/// Plain values of questions and answers.
///
/// Lengths are in model units, positions in the model's own frame: both are
/// what the input file said, unscaled and unmoved.
namespace planetree {

/// A position or a direction.
struct Vec3 {
  double x = 0, y = 0, z = 0;
};

/// The part of a triangle that is nearest.
enum class Feature : std::uint8_t { kFace, kEdge, kVertex };

/// How far an answer may be trusted.
enum class Status : std::uint8_t {
  kExact,              ///< proven: nothing left unread can be nearer
  kWithinError,        ///< upper - lower <= Ask::max_error
  kDegraded,           ///< pages unreadable or Ask::max_nodes spent; the interval still holds
  kBeyondMaxDistance,  ///< nothing within Ask::max_distance
  kBadQuery,           ///< the query, or a limit in the Ask, is not a number that makes sense
};

inline constexpr std::uint64_t kNoTriangle = std::numeric_limits<std::uint64_t>::max();

/// What is asked beyond the point itself.
struct Ask {
  /// May stop once upper - lower <= max_error. Model units, >= 0; 0 goes on
  /// until the answer is exact.
  double max_error = 0;
  /// Look no farther than this. Model units, >= 0.
  double max_distance = std::numeric_limits<double>::infinity();
  /// Most tree nodes and triangle blocks to visit.
  std::uint32_t max_nodes = std::numeric_limits<std::uint32_t>::max();
};

/// The nearest surface point to a query.
struct ClosestPoint {
  double distance = 0;  ///< >= 0: to `point`, the best surface point known
  double lower = 0;     ///< the true distance is at least this ...
  double upper = 0;     ///< ... and at most this; lower < upper even when exact
  Vec3 point;           ///< on the surface
  /// Counted in the input's order after fan-splitting polygons, triangles set
  /// aside included; kNoTriangle when none was reached. Among equally near
  /// triangles the one of least index.
  std::uint64_t triangle = kNoTriangle;
  Vec3 barycentric;  ///< of `point`, in the triangle's corner order; sums to 1
  Feature feature = Feature::kFace;
  Status status = Status::kBadQuery;
};

}  // namespace planetree
