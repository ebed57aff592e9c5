#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "octree/geometry/triangle_distance.h"
#include "octree/traversal/tree_view.h"

namespace planetree::octree {

class WorkLimit;

/// Where a query is with respect to the faces at its nearest point.
enum class Front : std::uint8_t {
  kUnknown,    ///< not proven, or no face there has area
  kInFront,    ///< on the side that the pseudo-normal points to
  kBehind,     ///< on the other side
  kLevel,      ///< in the plane of the pseudo-normal, off the surface
  kOnSurface,  ///< exactly on a triangle
};

/// Finds the sign of (query - x) . N, where N = sum of w_i n_i is the pseudo-normal at the nearest
/// point x: n_i are the unit normals of the faces there, w_i their angles at a vertex and 1 on an
/// edge or a face.
///
/// Proof of the sign. The feature lies in the planes of all its faces, so (query - x) . n_i has the
/// sign of an exact determinant. If none of these is negative, or none positive, the sign of the
/// sum is known without any rounding. Otherwise the sum is computed in double with a bound on its
/// error, and then with 113 bits, if the faces are not too many. What that cannot tell is unknown.
/// The result does not depend on the order in which faces are added.
///
/// source  the pseudo-normal is from Baerentzen & Aanaes 2005; the proof is our own
class FrontSide {
 public:
  /// query  must outlive this
  explicit FrontSide(const Point& query) : query_(query) {}

  /// Forgets all faces.
  ///
  /// by_angle  the feature is a vertex
  void begin(bool by_angle);

  /// Adds a face that has area.
  ///
  /// corner  number of a corner that is an end of the feature, the same for all faces
  /// weight  angle at that corner if the feature is a vertex, right to 2^-50; else 1
  /// limit   charged for exact signs; the caller charges the rest
  void add(const Triangle& face, unsigned corner, std::uint64_t index, double weight,
           WorkLimit& limit);

  /// Returns the side of the pseudo-normal.
  ///
  /// cancelled  the sum of normals counts as zero, so that the face of least index decides
  /// limit      charged for wide numbers; if it refused anything, the result is kUnknown
  Front front(bool cancelled, WorkLimit& limit);

 private:
  __extension__ using Int128 = __int128;

  struct Face {
    std::uint64_t index;
    unsigned corner;
    Point from, next, last;  // corners, from the one at the feature on
  };

  void add_in_double(const Point& u, const Point& v, const Point& way, double weight);
  Front sum_in_quad() const;

  static constexpr std::size_t kMax = 32;  // faces that are summed with 113 bits
  static constexpr double kUnit = 0x1p-60;

  const Point& query_;
  bool by_angle_ = false;
  bool has_front_ = false, has_behind_ = false, has_level_ = false;
  std::uint64_t first_index_ = 0;
  int first_side_ = 0;
  // The sum in double and its error, as shares of the distance and in whole units, so that the
  // order of the faces does not matter.
  Int128 sum_ = 0, error_ = 0;
  bool is_mild_ = true;  // no face takes wider numbers
  std::size_t count_ = 0;
  std::array<Face, kMax> faces_;  // without those in whose plane the query is
};

/// Returns kInFront if a query is in front of all triangles within `reach`, kBehind if it is behind
/// all of them, kOnSurface if it is on one, else kUnknown, also if pages or work were missing.
/// Triangles without area count only for
/// kOnSurface. For queries so near to the surface that rounding leaves their nearest feature
/// uncertain: the true one has only faces within reach, so it decides as they do.
///
/// reach     at least the distance to the surface, model frame
/// max_work  maximum work in units, see WorkLimit
Front front_of_all_within(const TreeInfo& tree, const Point& query, double reach,
                          std::uint64_t max_work, const PageReader& pages,
                          TraversalStats& work) noexcept;

}  // namespace planetree::octree
