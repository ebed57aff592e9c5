#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

/// @file
/// Values that queries take and return.
///
/// units   lengths and positions are in model units: the units of the input mesh. The scaled
///         coordinates that the library uses inside (the model frame) are not visible to callers.
/// axes    positions and directions are in the coordinate system of the input mesh.

namespace planetree {

/// Three numbers: a position or a direction, or the barycentric coordinates of a point. A position
/// may have any finite coordinates. The length of a direction is stated where one is used.
struct Vec3 {
  double x = 0,  ///< first coordinate
      y = 0,     ///< second coordinate
      z = 0;     ///< third coordinate
};

/// A closed box with faces across the axes, in model units. It may be flat.
struct Box {
  Vec3 lower,  ///< lower corner
      upper;   ///< upper corner
};

/// The kind of part of the nearest triangle that the nearest point is on.
enum class Feature : std::uint8_t {
  kFace,   ///< the interior of the triangle, without edges and corners
  kEdge,   ///< one of its edges, between two corners
  kVertex  ///< one of its corners
};

/// Where a point is with respect to the solid that the surface bounds.
///
/// The winding number w of a point is the sum of the signed solid angles of all triangles as seen
/// from the point, divided by 4 pi. If the surface is watertight, w is an integer. A point off the
/// surface is inside if |w| > 1/2. So a point is inside if several overlapping or nested solids of
/// the same orientation enclose it, if a solid that the mesh has twice encloses it, or if an
/// inside-out solid does. A cavity whose surface has the opposite orientation is outside. Across a
/// hole in the surface w changes smoothly, and the side changes where |w| = 1/2, as if a surface
/// closed the hole. All this holds by SideRule::kSolid. By SideRule::kSurface the nearest feature
/// decides.
///
/// source  Jacobson et al. 2013, "Robust inside-outside segmentation using generalized winding
///         numbers".
enum class Side : std::uint8_t {
  kInside,     ///< off the surface, |w| > 1/2, or behind a sheet
  kOutside,    ///< off the surface, |w| < 1/2, or in front of a sheet
  kOnSurface,  ///< exactly on a triangle
  /// Not known, for one of these reasons: the side was not requested; a page is missing or
  /// unreadable; QueryOptions::max_work is spent; |w| is too close to 1/2 to decide; the side
  /// layer is not open (see OpenOptions::layers); or the file has the triangles of a region only,
  /// and these do not determine the side (see ModelInfo::has_region). By SideRule::kSurface also
  /// if the nearest triangle is not proven, if no face at the nearest point has area, or if wide
  /// numbers cannot tell the sign.
  kUnknown,
};

/// How the side of a point is decided.
enum class SideRule : std::uint8_t {
  /// As the file says: ModelInfo::side_rule, which the builder chose (BuildOptions::side).
  kOfFile,
  /// The surface bounds a solid: by the winding number, see Side.
  kSolid,
  /// The surface is an open sheet, such as a terrain: by the nearest face, edge or vertex. The
  /// side is kOutside in front of its angle-weighted pseudo-normal, kInside behind it. A point
  /// exactly in the plane of the pseudo-normal, as beyond a border of a flat sheet, is kOutside.
  /// If the sum of the normals cancels, the nearest face of least index decides. The side is exact
  /// or kUnknown. It belongs to the nearest triangle, so the query searches for that whatever
  /// `max_error` is.
  ///
  /// source  Baerentzen & Aanaes 2005, "Signed distance computation using the angle weighted
  ///         pseudonormal".
  kSurface,
};

/// Which way the contact normal points.
enum class NormalRule : std::uint8_t {
  kOutward,      ///< out of the solid, or, by SideRule::kSurface, as the mesh is oriented
  kTowardQuery,  ///< to the query's side of the surface; on the surface, as the mesh is oriented
};

/// What is proven of an answer. The status concerns all requested parts: kDegraded if any part is
/// not proven. The interval contains the true distance for every status.
enum class Status : std::uint8_t {
  /// No triangle that the query skipped can be nearer, and side and normal are proven, so that the
  /// side is not kUnknown. If the query point is 10^12 or more diagonals of the
  /// model's box away, the interval is wider than the model. The triangle is then that of least
  /// computed distance, and another one may be nearer.
  kExact,
  /// Not exact, but upper - lower <= QueryOptions::max_error, and `distance` lies in the interval.
  /// A triangle other than the reported one may be nearer. Most such answers come from the coarse
  /// field of the file and report no triangle. The side is as for kExact. The normal is that of
  /// the reported triangle; without one it is the direction between `point` and the query, out of
  /// the solid. In a batch such an answer depends on the file and the query alone. A single query
  /// near the last one of its probe may be answered exactly instead, where that costs less.
  kWithinError,
  /// Not exact: a page is missing or unreadable, QueryOptions::max_work is spent, triangles
  /// outside of the region may be nearer (see ModelInfo::has_region), or a requested side is
  /// unknown because |w| is 1/2 to the last bits, the query is beyond a wall of the region, or the
  /// side layer is not open. The distance is exact all the same if the interval is as narrow as
  /// rounding allows.
  kDegraded,
  /// No surface within QueryOptions::max_distance. By SideRule::kSolid the side is computed as
  /// usual and may be kUnknown. By SideRule::kSurface it is kUnknown.
  kBeyondMaxDistance,
  kBadQuery,  ///< a coordinate of the query point is not finite, or an option is out of range
};

/// Value of ClosestPoint::triangle if the query found no triangle.
inline constexpr std::uint64_t kNoTriangle = std::numeric_limits<std::uint64_t>::max();

/// Part of an answer: nearest point, triangle and interval. See QueryOptions::parts.
inline constexpr std::uint32_t kDistance = 1;
/// Part of an answer: the side.
inline constexpr std::uint32_t kSide = 2;
/// Part of an answer: the contact normal. A query for kNormal also computes kDistance and kSide and
/// sets their members.
inline constexpr std::uint32_t kNormal = 4;
/// All parts of an answer.
inline constexpr std::uint32_t kAllParts = kDistance | kSide | kNormal;

/// Whether a query waits for pages that are not in memory.
enum class Wait : std::uint8_t {
  /// Blocking query: reads missing pages from the file. The answer is exact unless a page is
  /// unreadable or a wait for a page exceeds OpenOptions::wait_limit_ms. Then it is kDegraded.
  kForPages,
  /// Real-time query: answers from the pages in memory and does not wait. If these pages do not
  /// suffice, the answer is kDegraded and its interval is wider. The model's fetch threads then
  /// read the missing pages.
  kNever,
};

/// Options of a query. A value out of range gives Status::kBadQuery.
struct QueryOptions {
  /// Any of kDistance, kSide and kNormal, combined with `|`. Other bits are out of range. A part
  /// that is not requested is not computed, and its pages are not read. Without kDistance and
  /// kNormal only `side` and `status` are set: `distance` and `upper` are infinite, `lower` is 0
  /// and `triangle` is kNoTriangle. With 0 the query computes nothing.
  std::uint32_t parts = kAllParts;
  Wait wait = Wait::kForPages;                    ///< blocking or real-time query
  SideRule side_rule = SideRule::kOfFile;         ///< how the side is decided
  NormalRule normal_rule = NormalRule::kOutward;  ///< which way the contact normal points
  /// The search may stop once upper - lower <= max_error. Model units, finite, >= 0. With 0 the
  /// search continues until the answer is exact. It also does if SideRule::kSurface is to tell the
  /// side.
  double max_error = 0;
  /// The search finds surface at this distance or nearer. If there is none, the status is
  /// kBeyondMaxDistance. Model units, >= 0, may be infinite.
  double max_distance = std::numeric_limits<double>::infinity();
  /// Maximum work, in units of at most about 2,000 instructions. A visit of a node or block of the
  /// tree or of a grey cell of the mask is one unit. Distances, crossing tests, solid angles,
  /// exact signs and the faces at an edge or a vertex are charged too, so that the limit bounds
  /// the time of a query whatever the file holds. If it is reached, the answer is kDegraded. 0 is
  /// allowed. A single query starts near the last answer of its probe, so that an answer that is
  /// not exact depends on the probe's earlier queries. An answer of a blocking batch does not. The
  /// distance search uses the work first. The search for the side gets what is left, then the
  /// normal. kNoLimit, the default, means no limit for Wait::kForPages and kRealTimeWork for
  /// Wait::kNever. For a real-time query that is practically without a limit, give kNoLimit - 1.
  std::uint32_t max_work = kNoLimit;

  /// Value of `max_work` that selects the default of the wait mode.
  static constexpr std::uint32_t kNoLimit = std::numeric_limits<std::uint32_t>::max();
  /// Default of `max_work` for Wait::kNever.
  static constexpr std::uint32_t kRealTimeWork = 4096;
};

/// The answer to a closest-point query. No member is ever NaN.
struct ClosestPoint {
  /// Distance to `point`, model units, >= 0. For kExact, lower <= distance <= upper. For kDegraded,
  /// `distance` may be greater than `upper`, because `upper` may come from the box of a subtree
  /// that the query skipped; with the coarse field it rarely is. If no triangle was found, it
  /// equals `upper`. It is infinite if the status is kBeyondMaxDistance or kBadQuery or if no
  /// distance was requested.
  double distance = 0;
  /// Certified lower bound of the true distance, model units, >= 0. It is max_distance if the
  /// status is kBeyondMaxDistance. It is 0 if the status is kBadQuery or no distance was requested.
  double lower = 0;
  /// Certified upper bound of the true distance, model units. It is infinite if `distance` is. The
  /// interval includes rounding, so lower < upper for every status.
  double upper = 0;
  Side side = Side::kUnknown;  ///< side of the query point
  /// Best surface point known. Without a triangle it is a point of the coarse field, which is at
  /// most 2^-16 of the model's longest edge off the surface, or the sample vertex of the model. It
  /// is (0, 0, 0) if the status is kBeyondMaxDistance or kBadQuery or if no distance was requested.
  Vec3 point;
  /// Contact normal, of length 1: the angle-weighted pseudo-normal of the nearest face, edge or
  /// vertex. By SideRule::kSurface it follows the orientation of the mesh. By
  /// NormalRule::kTowardQuery it points to the query's side of the surface, whatever the side rule;
  /// if that is not proven, it follows the orientation of the mesh and the status is kDegraded.
  /// Otherwise the first rule that applies decides its sign:
  ///
  /// - If `side` is kUnknown, the normal follows the orientation of the mesh.
  /// - If `triangle` is not proven to be the nearest, the normal follows the orientation of the
  ///   mesh, and is reversed if the winding number is negative.
  /// - If `side` is kOutside, the normal points towards the query point; if kInside, away from it.
  ///   So beside an open surface that encloses no space, it points towards the query point on both
  ///   sides of the surface.
  /// - If `side` is kOnSurface, the normal points out of the solid. Where both sides of the surface
  ///   are outside or both inside, it follows the orientation of the mesh, and is reversed if the
  ///   winding number of the rest of the surface is negative.
  ///
  /// Without a triangle it is the direction between `point` and the query, out of the solid, if the
  /// status is kWithinError or kDegraded. It is (0, 0, 1) if no normal was requested, if there is
  /// no point, and if no face at the nearest point has area.
  Vec3 normal{0, 0, 1};
  /// Index of the nearest triangle: its position in the input, from 0. A polygon of n corners
  /// counts as n - 2 triangles. Skipped records count too. If several triangles are equally near as
  /// computed in double, it is the lowest index. It is kNoTriangle if no triangle was found.
  std::uint64_t triangle = kNoTriangle;
  /// Barycentric coordinates of `point`, in the order of the triangle's corners. Up to rounding
  /// they sum to 1. A point on a face has three positive coordinates, on an edge two, at a vertex
  /// one; the others are exactly 0. All are 0 if no triangle was found.
  Vec3 barycentric;
  Feature feature = Feature::kFace;   ///< where `point` is on the triangle, if there is one
  Status status = Status::kBadQuery;  ///< what is proven of the answer

  /// Returns -distance if `side` is kInside, else distance, also for kOnSurface and kUnknown. It is
  /// infinite if `distance` is.
  double signed_distance() const noexcept { return side == Side::kInside ? -distance : distance; }
};

/// How many triangles, hits or contacts a query found, see Probe::nearest_triangles,
/// Probe::all_hits and Probe::contacts.
struct Found {
  std::size_t count = 0;  ///< answers written
  bool complete = false;  ///< whether no other one belongs to the set

  /// A set counts as the number of its answers.
  operator std::size_t() const noexcept { return count; }
};

/// The answer to a query for the side alone.
struct Containment {
  Side side = Side::kUnknown;  ///< side of the query point
  /// kDegraded if the side is unknown because pages, work or, by SideRule::kSurface, a proof were
  /// missing; kBadQuery; else kExact.
  Status status = Status::kBadQuery;
};

}  // namespace planetree
