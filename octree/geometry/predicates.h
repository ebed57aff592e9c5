#pragma once

#include <span>

#include "octree/geometry/triangle_distance.h"
#include "planetree/types.h"

/// Signs of determinants, exact for all finite points. A filter in double decides most calls,
/// integers the others.
///
/// All functions return -1, 0 or 1 and may be called from any thread. Functions with a `limit`
/// charge it for each sign that takes integers; the caller charges the rest. If the limit refuses,
/// which limit->exceeded() tells, the result has no meaning. Null: no limit. Coordinates are in the
/// model frame: finite, of magnitude at most 2^301.
///
/// source  the filter's bound is from Shewchuk 1997, "Adaptive precision floating-point arithmetic
///         and fast robust geometric predicates". Ours is wider, so that a thread that rounds in
///         another direction or flushes subnormal numbers gets the same signs.
namespace planetree::octree {

class WorkLimit;

/// Returns the side of the plane through a, b, c that d is on: 1 on the side of the normal (b - a)
/// x (c - a), 0 on the plane or if a, b, c are collinear.
int orientation(const Point& a, const Point& b, const Point& c, const Point& d,
                WorkLimit* limit = nullptr) noexcept;

/// Returns the sign of component `axis`, 0 to 2, of (b - a) x (c - a).
int normal_sign(const Point& a, const Point& b, const Point& c, unsigned axis,
                WorkLimit* limit = nullptr) noexcept;

/// Returns the sign of component `axis` of a closed polygon's area vector: 1 if the polygon runs
/// counterclockwise seen against the axis. At most 2^20 corners.
int polygon_area_sign(std::span<const Vec3> corners, unsigned axis) noexcept;

/// Returns the side of a triangle's plane that `point` is on after its infinitesimal step (see
/// PerturbedSegment). The result is 0 only if the triangle has no area.
int perturbed_side(const Triangle& triangle, const Point& point,
                   WorkLimit* limit = nullptr) noexcept;

/// Returns whether `point` lies on the closed triangle, which may be a segment or a point.
bool lies_on(const Point& point, const Triangle& triangle, WorkLimit* limit = nullptr) noexcept;

/// A segment whose ends are moved by infinitesimal steps, so that it never meets a vertex, edge or
/// face edge-on. The perturbed ends are from + (e1, e2, e3) and to + (d1, d2, d3) with e1 >> e2 >>
/// e3 >> d1 >> d2 >> d3 > 0; each step is smaller than every power of the one before. A point takes
/// the same step on every segment, except for the step's length, so that winding numbers counted
/// along different segments agree.
///
/// source  simulation of simplicity, Edelsbrunner & Muecke 1990
struct PerturbedSegment {
  Point from, to;
};

/// Returns the change of the winding number that one triangle causes along `segment`, from `to`
/// back to `from`:
///
///     winding(from) = winding(to) + sum of crossing() over all triangles
///
/// The result is 1 or -1 if the segment passes through the triangle, 1 if `from` is behind it as
/// seen along its normal (b - a) x (c - a), and 0 otherwise. A triangle without area is never
/// crossed.
int crossing(const PerturbedSegment& segment, const Triangle& triangle,
             WorkLimit* limit = nullptr) noexcept;

/// The same as orientation(), normal_sign() and polygon_area_sign(), for arguments that the filter
/// in double cannot decide. They compute in integers: no allocation, no rounding, no dependence on
/// the thread's floating-point mode. The first two take some 50 ns if the coordinates have at most
/// 40 bits along each axis, as those of float models mostly do, otherwise about a microsecond. The
/// last takes about a microsecond per corner.
int exact_orientation(const Point& a, const Point& b, const Point& c, const Point& d,
                      WorkLimit* limit = nullptr) noexcept;
int exact_normal_sign(const Point& a, const Point& b, const Point& c, unsigned axis,
                      WorkLimit* limit = nullptr) noexcept;
int exact_polygon_area_sign(std::span<const Vec3> corners, unsigned axis) noexcept;

}  // namespace planetree::octree
