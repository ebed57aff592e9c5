#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "planetree/probe.h"

namespace planetree::tools {

/// Which triangles or contacts about each point a command lists.
struct TriangleRowsQuery {
  /// Most triangles or contacts of a point if only a radius is given.
  static constexpr std::uint64_t kDefaultNearest = 100000;
  static constexpr std::uint64_t kNotGiven = std::numeric_limits<std::uint64_t>::max();

  std::uint64_t nearest = kNotGiven;                        ///< at most so many, at least 1
  double radius = std::numeric_limits<double>::infinity();  ///< model units
  /// If given: the contacts within this radius in place of the triangles.
  double contact_radius = std::numeric_limits<double>::infinity();

  bool wants_contacts() const { return contact_radius < std::numeric_limits<double>::infinity(); }
  bool is_given() const {
    return nearest != kNotGiven || radius < std::numeric_limits<double>::infinity() ||
           wants_contacts();
  }
};

/// Finds the triangles or contacts about points, a row for each, the nearest first.
///
/// A point has at least one row. One without a triangle says why by its status: none is within the
/// radius (kBeyondMaxDistance), the point is not finite (kBadQuery), or, after the rows of the
/// triangles, that some may lack (kDegraded).
class TriangleRows {
 public:
  /// probe  must outlive this
  TriangleRows(Probe& probe, const QueryOptions& options, const TriangleRowsQuery& query)
      : probe_(probe), options_(options), query_(query) {}

  /// Answers points; replaces the rows.
  void answer(std::span<const Vec3> points);

  /// The point of each row, and its answer.
  std::span<const Vec3> points() const { return points_; }
  std::span<const ClosestPoint> rows() const { return rows_; }

 private:
  void answer(const Vec3& point);
  Found find(const Vec3& point, std::span<ClosestPoint> room);
  void add_without_triangle(const Vec3& point, Status status);

  Probe& probe_;
  const QueryOptions options_;
  const TriangleRowsQuery query_;
  std::vector<ClosestPoint> found_;  // of one point
  std::vector<Vec3> points_;
  std::vector<ClosestPoint> rows_;
};

}  // namespace planetree::tools
