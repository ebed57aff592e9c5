#include "octree/nearest/feature_normal.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>

#include <Eigen/Geometry>

#include "octree/geometry/angles.h"
#include "octree/geometry/error_bounds.h"
#include "octree/geometry/predicates.h"
#include "octree/geometry/strict_math.h"
#include "octree/geometry/wide_numbers.h"
#include "octree/geometry/work_limit.h"
#include "octree/nearest/height_field.h"
#include "octree/traversal/overlap.h"
#include "octree/traversal/tree_walk.h"

namespace planetree::octree {
namespace {

Point thin_normal(const Triangle& triangle) {
  const Vector3<Quad> normal =
      cross(difference<Quad>(triangle[1], triangle[0]), difference<Quad>(triangle[2], triangle[0]));
  using boost::multiprecision::abs;
  const Quad largest = std::max({Quad(abs(normal[0])), Quad(abs(normal[1])), Quad(abs(normal[2]))});
  if (largest == 0) return Point::Zero();
  const Point shorter(static_cast<double>(normal[0] / largest),
                      static_cast<double>(normal[1] / largest),
                      static_cast<double>(normal[2] / largest));
  return shorter / shorter.norm();
}

/// Sums the normals of the faces around an edge or a vertex. Up to kSorted faces are summed in the
/// order of their indices, so that the order in which they are found does not matter.
class Fan {
 public:
  /// other  the edge's other end; null for a vertex.
  /// sides, front_side  receive every face; may be null.
  /// limit  charged for each face
  Fan(const Point& vertex, const Point* other, FacingSides* sides, FrontSide* front_side,
      WorkLimit& limit)
      : vertex_(vertex), other_(other), sides_(sides), front_side_(front_side), limit_(limit) {}

  void add(const Triangle& triangle, std::uint64_t index) {
    for (unsigned corner = 0; corner < 3; ++corner) {
      if (triangle[corner] != vertex_) continue;
      if (!limit_.take()) return;
      const Point& next = triangle[(corner + 1) % 3];
      const Point& last = triangle[(corner + 2) % 3];
      if (other_ && next != *other_ && last != *other_) continue;
      if (count_ == kSorted) {
        sorted_ = false;
        sum_up();
      }
      Face& face = faces_[count_];
      if (corner != last_corner_ || triangle != last_triangle_)
        measure(triangle, corner, next - vertex_, last - vertex_);
      if (sides_) has_area_ ? sides_->add(triangle, normal_, area2_) : sides_->add_unknown();
      if (!has_area_) continue;
      if (front_side_) front_side_->add(triangle, corner, index, weight_, limit_);
      face.normal = normal_;
      face.index = index;
      face.corner = corner;
      face.weight = weight_;
      ++count_;
    }
  }

  /// Whether normal() is independent of the order in which faces were found.
  bool is_sorted() const { return sorted_; }

  Point normal() {
    std::sort(faces_, faces_ + count_, [](const Face& a, const Face& b) {
      return a.index != b.index ? a.index < b.index : a.corner < b.corner;
    });
    sum_up();
    const double length = sum_.norm();
    is_cancelled_ = !(length > kCancelledNormalShare * weights_);
    return is_cancelled_ ? first_ : Point(sum_ / length);
  }
  /// Whether normal() is that of one face, because the sum is zero up to rounding.
  bool is_cancelled() const { return is_cancelled_; }

 private:
  struct Face {
    std::uint64_t index;
    unsigned corner;
    double weight;
    Point normal;
  };

  // Computes normal and weight of a face. Many faces may coincide; only the first is measured.
  void measure(const Triangle& triangle, unsigned corner, const Point& next, const Point& last) {
    last_triangle_ = triangle;
    last_corner_ = corner;
    has_area_ = face_normal(triangle, normal_, area2_, &limit_);
    weight_ = other_ || !has_area_ ? 1 : angle_between(next, last);
  }

  void sum_up() {
    for (const Face& face : std::span(faces_, count_)) {
      sum_ += face.weight * face.normal;
      weights_ += face.weight;
      if (face.index >= first_index_) continue;
      first_index_ = face.index;
      first_ = face.normal;
    }
    count_ = 0;
  }

  static constexpr std::size_t kSorted = NearbyTriangles::kMax;

  const Point& vertex_;
  const Point* other_;  ///< the edge's other end; null for a vertex
  FacingSides* sides_;
  FrontSide* front_side_;
  WorkLimit& limit_;
  bool sorted_ = true;
  bool is_cancelled_ = true;
  std::size_t count_ = 0;
  Face faces_[kSorted];
  Point sum_ = Point::Zero();
  double weights_ = 0;
  Point first_ = Point::Zero();
  std::uint64_t first_index_ = kNoTriangle;
  // The last face measured, if last_corner_ is below 3.
  unsigned last_corner_ = 3;
  Triangle last_triangle_;
  bool has_area_;
  double area2_;
  double weight_;
  Point normal_;
};

/// Computes the normal where the nearest point is inside a face.
void normal_of_face(const Point& query, const NearestAnswer& nearest, WorkLimit& limit,
                    FeatureNormal& found, FrontSide* front_side) {
  double area2 = 0;
  if (!face_normal(nearest.corners, found.normal, area2, &limit)) {
    found.normal = Point::Zero();
    found.complete = !limit.exceeded();
    return;
  }
  if (front_side) {
    front_side->begin(false);
    front_side->add(nearest.corners, 0, nearest.triangle, 1, limit);
    found.front = front_side->front(false, limit);
    found.complete = !limit.exceeded();
  }
  if (!nearest.is_height_field) return;
  FacingSides sides(query);
  sides.add(nearest.corners, found.normal, area2);
  sides.end_after(*std::min_element(nearest.barycentric.begin(), nearest.barycentric.end()) *
                  std::sqrt(area2));
  found.side = sides.common();
}

void add_faces(const Point& vertex, const NearbyTriangles& triangles, Fan& fan) {
  const NearbyTriangleBits around = triangles_with_corner(triangles, vertex);
  for (std::size_t word = 0; word < around.size(); ++word)
    for (std::uint64_t bits = around[word]; bits != 0; bits &= bits - 1) {
      const std::size_t i = 64 * word + static_cast<std::size_t>(std::countr_zero(bits));
      fan.add(triangles.triangle(i), triangles.id(i));
    }
}

// Adds the faces at a vertex: those below `subtrees`, or below the root if that is null. Returns
// false if pages or work were missing.
bool walk_to(const Point& vertex, const NearbySubtrees* subtrees, Fan& fan, const TreeInfo& tree,
             std::uint64_t max_work, const PageReader& pages, TraversalStats& work) {
  const Outcodes outcodes(vertex, vertex);
  BoxWalk walk(tree, vertex, vertex, pages, work);
  if (subtrees) walk.start_from(*subtrees);
  return walk.run(max_work, [&](const BlockView& block, std::uint32_t) {
    for (unsigned around = outcodes.with_corner_within(block); around != 0; around &= around - 1) {
      const auto i = static_cast<unsigned>(std::countr_zero(around));
      fan.add(block.triangle(i), block.id(i));
    }
  });
}

}  // namespace

bool face_normal(const Triangle& triangle, Point& unit, double& area2, WorkLimit* limit) noexcept {
  const Point u = triangle[1] - triangle[0], v = triangle[2] - triangle[0];
  const Point normal = u.cross(v);
  area2 = normal.squaredNorm();
  const bool short_edge =
      std::min(u.squaredNorm(), v.squaredNorm()) < kMinNormalEdge * kMinNormalEdge;
  if (!short_edge && area2 > kThinFaceSine2 * u.squaredNorm() * v.squaredNorm()) {
    unit = normal / std::sqrt(area2);
    return true;
  }
  // As of segments and points, which a vertex may have many of.
  if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0])
    return false;
  if (limit && !limit->try_take(WorkUnits::kThinNormal)) return false;
  bool flat = true;
  for (unsigned axis = 0; axis < 3; ++axis)
    flat = flat && normal_sign(triangle[0], triangle[1], triangle[2], axis, limit) == 0;
  if (!flat) unit = thin_normal(triangle);
  return !flat;
}

void feature_normal(const TreeInfo& tree, const Point& query, const NearestAnswer& nearest,
                    const CoherenceCache* coherence_cache, std::uint64_t max_work,
                    const PageReader& pages, TraversalStats& work, FeatureNormal& found,
                    FrontSide* front_side) noexcept {
  found.complete = true;
  found.side = 0;
  found.front = Front::kUnknown;
  WorkLimit limit(work.units, max_work);
  if (nearest.feature == Feature::kFace)
    return normal_of_face(query, nearest, limit, found, front_side);
  // Corners of the feature that holds the nearest point: one of a vertex, two of an edge.
  const Point* ends[3] = {};
  double shares[3] = {};
  std::size_t count = 0;
  for (std::size_t corner = 0; corner < 3; ++corner) {
    if (!(nearest.barycentric[corner] > 0)) continue;
    shares[count] = nearest.barycentric[corner];
    ends[count++] = &nearest.corners[corner];
  }
  const Point& vertex = *ends[0];
  const bool on_edge = nearest.feature == Feature::kEdge;
  FacingSides sides(query);
  if (front_side) front_side->begin(!on_edge);
  Fan fan(vertex, on_edge ? ends[1] : nullptr, nearest.is_height_field ? &sides : nullptr,
          front_side, limit);
  if (on_edge) sides.end_after(std::min(shares[0], shares[1]) * (*ends[1] - vertex).norm());
  const bool use_cache = coherence_cache && coherence_cache->has_all_at(nearest.point);
  if (use_cache && coherence_cache->triangles().complete()) {
    add_faces(vertex, coherence_cache->triangles(), fan);
  } else {
    const NearbySubtrees* subtrees = use_cache ? &coherence_cache->subtrees() : nullptr;
    found.complete = walk_to(vertex, subtrees, fan, tree, limit.left(), pages, work);
    // So many faces are summed in the order of a walk from the root, which no cache changes.
    if (subtrees && !fan.is_sorted())
      return feature_normal(tree, query, nearest, nullptr, limit.left(), pages, work, found,
                            front_side);
  }
  found.complete = found.complete && !limit.exceeded();
  found.normal = fan.normal();
  if (found.complete && nearest.is_height_field) found.side = sides.common();
  if (found.complete && front_side) {
    found.front = front_side->front(fan.is_cancelled(), limit);
    found.complete = !limit.exceeded();
  }
  // Not even the page of the nearest triangle was available: its own normal is the best known.
  double area2 = 0;
  if (!found.complete && found.normal.squaredNorm() == 0 &&
      !face_normal(nearest.corners, found.normal, area2, &limit))
    found.normal = Point::Zero();
}

}  // namespace planetree::octree
