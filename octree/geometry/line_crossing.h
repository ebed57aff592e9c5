#pragma once

#include "octree/geometry/predicates.h"
#include "octree/geometry/triangle_distance.h"

/// Where lines pass through triangles: exact signs, and positions with proven errors.
namespace planetree::octree {

class WorkLimit;

/// The line origin + t (head - tail), without rounding. A ray has its direction as `head` and zero
/// as `tail`; a segment has its ends. The origin and the direction are moved by infinitesimal steps
/// (e1, e2, e3) and (d1, d2, d3), e1 >> e2 >> e3 >> d1 >> d2 >> d3 > 0, each smaller than every
/// power of the one before. So the line never meets an edge or a vertex, and of the triangles that
/// share an edge through which it passes, it meets exactly one if they lie on different sides of
/// the edge as seen along the line; else none or both.
///
/// Coordinates: finite, of magnitude at most 2^301.
///
/// source  simulation of simplicity, Edelsbrunner & Muecke 1990
struct Line {
  Point origin, head, tail;

  Point direction() const { return head - tail; }
};

/// Positions on a line, both included; `upper` may be infinite.
struct LineRange {
  double lower = 0, upper = 0;
};

/// Where a line passes through a triangle.
struct LineCrossing {
  /// 1 if the line passes against the triangle's normal (b - a) x (c - a), -1 if along it, 0 if not
  /// at all or outside of the range.
  int sign = 0;
  double t = 0;      ///< position on the line; the same bits for any order of the corners
  double error = 0;  ///< bound on the error of `t`
};

/// Returns where a line passes through a triangle within a range. Whether it passes is exact, and
/// so is the order of `t` and 0 or 1: a line that begins on the triangle has t = 0. A triangle
/// whose `t`, as rounded, is in the range counts, so that the ends of a segment are exact. A
/// triangle without area is never met. A line without a direction meets the triangles that its
/// origin is on, at 0.
///
/// limit   charged for exact numbers. If it refuses, which limit->exceeded() tells, the result has
///         no meaning. Null: no limit.
LineCrossing cross(const Line& line, const LineRange& range, const Triangle& triangle,
                   WorkLimit* limit = nullptr) noexcept;

/// Returns the sign of (o - b) . (D x (a - b)) for the line o + t D: the side on which it passes
/// the line from b to a. Exact; 0 if the lines meet or are parallel.
int exact_line_side(const Line& line, const Point& a, const Point& b,
                    WorkLimit* limit = nullptr) noexcept;
/// Returns the sign of component `axis` of D x (a - b).
int exact_turn_sign(const Line& line, const Point& a, const Point& b, unsigned axis,
                    WorkLimit* limit = nullptr) noexcept;
/// Returns the position at which a line meets a triangle's plane, right within kRatioRounding of
/// itself or kMinPosition, and on the same side of 0 and 1. The line must not be parallel to the
/// plane.
double exact_position(const Line& line, const Triangle& triangle,
                      WorkLimit* limit = nullptr) noexcept;

}  // namespace planetree::octree
