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

/// Where a point is with respect to the solid that the surface bounds.
///
/// With w the winding number of the surface about the point (the sum of its
/// solid angles over 4 pi, a whole number where the surface is watertight), a
/// point off the surface is inside where |w| > 1/2. So overlapping, nested,
/// doubled and inside-out solids count as what they enclose, and holes are
/// closed as smoothly as may be ("Robust inside-outside segmentation using
/// generalized winding numbers", Jacobson et al. 2013).
enum class Side : std::uint8_t {
  kInside,
  kOutside,
  kOnSurface,  ///< exactly on a triangle
  /// Not told: pages unreadable, work spent, |w| is 1/2 to the last bits, or not all that counts
  /// is there (see ModelInfo::has_region).
  kUnknown,
};

/// How far an answer may be trusted.
enum class Status : std::uint8_t {
  kExact,        ///< proven: nothing left unread can be nearer
  kWithinError,  ///< upper - lower <= QueryOptions::max_error
  /// Pages missing or unreadable, or QueryOptions::max_work spent, or something nearer may have
  /// been left out (see ModelInfo::has_region); the interval holds.
  kDegraded,
  kBeyondMaxDistance,  ///< nothing within QueryOptions::max_distance
  kBadQuery,  ///< the query, or a limit in the QueryOptions, is not a number that makes sense
};

inline constexpr std::uint64_t kNoTriangle = std::numeric_limits<std::uint64_t>::max();

/// Parts of an answer, for QueryOptions::parts.
inline constexpr std::uint32_t kDistance = 1;  ///< nearest point, triangle and interval
inline constexpr std::uint32_t kSide = 2;
inline constexpr std::uint32_t kNormal = 4;  ///< needs the others and brings them
inline constexpr std::uint32_t kAllParts = kDistance | kSide | kNormal;

/// Whether an ask waits for pages that are not in memory.
enum class Wait : std::uint8_t {
  kForPages,  ///< reads them from the file, so that the answer is exact
  /// Real time: answers at once from what is in memory, by a certified interval where that is
  /// not enough. The model's fetch threads meanwhile get what was missing.
  kNever,
};

/// What is asked beyond the point itself.
struct QueryOptions {
  /// Of kDistance, kSide and kNormal any. What is not asked is not computed, nor
  /// are its pages read: without kDistance an answer is as if no triangle was
  /// reached.
  std::uint32_t parts = kAllParts;
  Wait wait = Wait::kForPages;
  /// May stop once upper - lower <= max_error. Model units, >= 0; 0 goes on
  /// until the answer is exact.
  double max_error = 0;
  /// Look no farther than this. Model units, >= 0.
  double max_distance = std::numeric_limits<double>::infinity();
  /// Most tree nodes and triangle blocks to visit. As it is by default there is no limit for
  /// Wait::kForPages, and kRealTimeWork for Wait::kNever.
  std::uint32_t max_work = kNoLimit;

  static constexpr std::uint32_t kNoLimit = std::numeric_limits<std::uint32_t>::max();
  static constexpr std::uint32_t kRealTimeWork = 4096;
};

/// The nearest surface point to a query.
struct ClosestPoint {
  /// >= 0: to `point`, the best surface point known, which may be beyond `upper` if degraded;
  /// if no triangle was reached, as far as the surface may be.
  double distance = 0;
  double lower = 0;  ///< the true distance is at least this ...
  double upper = 0;  ///< ... and at most this; lower < upper even when exact
  Side side = Side::kUnknown;
  Vec3 point;  ///< on the surface
  /// Contact normal, of length 1: the angle-weighted pseudo-normal of the face,
  /// edge or vertex that is nearest, turned to point out of the solid. Of a sheet
  /// that encloses nothing it points to the query. As the mesh is oriented where
  /// the side is unknown or the triangle not proven to be the nearest; (0, 0, 1)
  /// where there is none.
  Vec3 normal{0, 0, 1};
  /// Counted in the input's order after fan-splitting polygons, triangles set
  /// aside included; kNoTriangle when none was reached. Among equally near
  /// triangles the one of least index.
  std::uint64_t triangle = kNoTriangle;
  /// Of `point`, in the triangle's corner order; sums to 1. Above 0 for as many
  /// corners as `feature` has.
  Vec3 barycentric;
  Feature feature = Feature::kFace;
  Status status = Status::kBadQuery;

  /// Negative inside; positive where the side is unknown.
  double signed_distance() const noexcept { return side == Side::kInside ? -distance : distance; }
};

/// The side alone.
struct Containment {
  Side side = Side::kUnknown;
  Status status = Status::kBadQuery;  ///< kDegraded where pages or work were missing to tell
};

}  // namespace planetree
