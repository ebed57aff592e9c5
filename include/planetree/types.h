#pragma once

#include <cstdint>
#include <limits>

/// @file
/// Values that queries take and return.
///
/// units   lengths and positions are in model units, those of the input file.
/// frame   positions and directions are in the frame of the input file, neither scaled nor moved.

namespace planetree {

/// A position or a direction.
struct Vec3 {
  double x = 0,  ///< first coordinate
      y = 0,     ///< second coordinate
      z = 0;     ///< third coordinate
};

/// The part of a triangle that is nearest.
enum class Feature : std::uint8_t {
  kFace,   ///< the inside of the triangle
  kEdge,   ///< one of its edges, between two corners
  kVertex  ///< one of its corners
};

/// Where a point is with respect to the solid that the surface bounds.
///
/// The winding number w of a point is the sum of the solid angles of all triangles seen from it,
/// over 4 pi. It is a whole number where the surface is watertight. A point off the surface is
/// inside where |w| > 1/2. Space that overlapping, nested, doubled or inside-out solids enclose is
/// therefore inside. At a hole w changes smoothly, so that the hole counts as closed.
///
/// source  Jacobson et al. 2013, "Robust inside-outside segmentation using generalized winding
///         numbers".
enum class Side : std::uint8_t {
  kInside,     ///< off the surface, |w| > 1/2
  kOutside,    ///< off the surface, |w| < 1/2
  kOnSurface,  ///< exactly on a triangle
  /// Not known: pages are missing or unreadable, the work is spent, |w| is 1/2 to the last bits,
  /// or the file of a region does not determine it (see ModelInfo::has_region). Also where the
  /// side was not requested.
  kUnknown,
};

/// How far an answer is proven.
enum class Status : std::uint8_t {
  kExact,        ///< proven: nothing that was skipped can change the answer
  kWithinError,  ///< upper - lower <= QueryOptions::max_error; another triangle may be nearer
  /// Not proven: pages are missing or unreadable, QueryOptions::max_work is spent, or triangles
  /// outside of the region may be nearer (see ModelInfo::has_region). The interval still holds.
  kDegraded,
  /// No surface within QueryOptions::max_distance. The side may still be unknown.
  kBeyondMaxDistance,
  kBadQuery,  ///< the query is not finite, or an option is out of range
};

/// Value of ClosestPoint::triangle where no triangle was reached.
inline constexpr std::uint64_t kNoTriangle = std::numeric_limits<std::uint64_t>::max();

/// Part of an answer: nearest point, triangle and interval. See QueryOptions::parts.
inline constexpr std::uint32_t kDistance = 1;
/// Part of an answer: the side.
inline constexpr std::uint32_t kSide = 2;
/// Part of an answer: the contact normal. It needs the other parts and includes them.
inline constexpr std::uint32_t kNormal = 4;
/// All parts of an answer.
inline constexpr std::uint32_t kAllParts = kDistance | kSide | kNormal;

/// Whether a query waits for pages that are not in memory.
enum class Wait : std::uint8_t {
  /// Blocking: reads missing pages from the file, so that the answer is exact. A wait for one page
  /// ends at OpenOptions::wait_limit_ms.
  kForPages,
  /// Real time: answers at once from the pages in memory, with a certified interval where those do
  /// not suffice. The model's fetch threads then read the missing pages.
  kNever,
};

/// Options of a query. A value out of range gives Status::kBadQuery.
struct QueryOptions {
  /// Any of kDistance, kSide and kNormal, combined with `|`. A part that is not requested is not
  /// computed, and its pages are not read. Without kDistance and kNormal the answer is that of a
  /// query that reached no triangle.
  std::uint32_t parts = kAllParts;
  Wait wait = Wait::kForPages;  ///< blocking or real time
  /// The search may stop once upper - lower <= max_error. Model units, finite, >= 0. With 0 it
  /// goes on until the answer is exact.
  double max_error = 0;
  /// The search goes no farther than this. Model units, >= 0, may be infinite.
  double max_distance = std::numeric_limits<double>::infinity();
  /// Maximum work: one unit for each tree node, triangle block and mask node visited. The distance
  /// uses it first, the side what is left, the normal the rest. kNoLimit, the default, means no
  /// limit for Wait::kForPages and kRealTimeWork for Wait::kNever.
  std::uint32_t max_work = kNoLimit;

  /// Value of `max_work` that means the default.
  static constexpr std::uint32_t kNoLimit = std::numeric_limits<std::uint32_t>::max();
  /// Default limit of `max_work` for Wait::kNever.
  static constexpr std::uint32_t kRealTimeWork = 4096;
};

/// The surface point nearest to a query. No member is ever NaN.
struct ClosestPoint {
  /// Distance to `point`, model units, >= 0. In a degraded answer it may exceed `upper`. It equals
  /// `upper` where no triangle was reached, and is infinite where the status is
  /// kBeyondMaxDistance or kBadQuery or no distance was requested.
  double distance = 0;
  /// Certified lower bound of the true distance, model units, >= 0. Equals max_distance where the
  /// status is kBeyondMaxDistance.
  double lower = 0;
  /// Certified upper bound of the true distance, model units, may be infinite. Rounding is part of
  /// the interval: lower < upper even when exact.
  double upper = 0;
  Side side = Side::kUnknown;  ///< side of the query
  /// Best surface point known. A sample vertex of the model where pages or work were missing to
  /// reach a triangle. (0, 0, 0) where the status is kBeyondMaxDistance or kBadQuery or no
  /// distance was requested.
  Vec3 point;
  /// Contact normal, of length 1: the angle-weighted pseudo-normal of the nearest face, edge or
  /// vertex, turned to point out of the solid. Next to an open surface that encloses nothing it
  /// points to the query. It is as the mesh is oriented where the side is unknown. Where the
  /// triangle is not proven to be the nearest it is turned only if the winding number is negative.
  /// (0, 0, 1) where there is none.
  Vec3 normal{0, 0, 1};
  /// Index of the nearest triangle in the input's order, counted after each polygon of n
  /// corners is split into n - 2 and with skipped records included. Of equally near triangles the
  /// one of least index. kNoTriangle where no triangle was reached.
  std::uint64_t triangle = kNoTriangle;
  /// Barycentric coordinates of `point`, in the triangle's corner order. They sum to 1, and are
  /// above 0 for as many corners as `feature` has: 3, 2 or 1. All 0 where no triangle was reached.
  Vec3 barycentric;
  Feature feature = Feature::kFace;   ///< part of the triangle that `point` is on
  Status status = Status::kBadQuery;  ///< how far the answer is proven

  /// The distance, negative where the side is kInside. Positive where the side is unknown.
  double signed_distance() const noexcept { return side == Side::kInside ? -distance : distance; }
};

/// The side of a query alone.
struct Containment {
  Side side = Side::kUnknown;         ///< side of the query
  Status status = Status::kBadQuery;  ///< kExact, kDegraded for want of pages or work, or kBadQuery
};

}  // namespace planetree
