#pragma once

#include "octree/geometry/triangle_distance.h"

/// Signs of determinants, exact for all finite points: a filter in double, and
/// whole numbers where it cannot tell (Shewchuk 1997, "Adaptive precision
/// floating-point arithmetic and fast robust geometric predicates", gives the
/// filter's bound; ours is wider, so that a host thread that rounds another way
/// or flushes subnormals gets the same signs).
///
/// All functions return -1, 0 or 1 and may be called from any thread. Coordinates
/// are in the model frame: finite, of magnitude at most 2^301.
namespace planetree::octree {

/// Side of the plane through a, b, c that d is on: 1 where the normal
/// (b - a) x (c - a) points to, 0 on the plane or where a, b, c are collinear.
int orientation(const Point& a, const Point& b, const Point& c, const Point& d) noexcept;

/// The sign of one component, 0 to 2, of (b - a) x (c - a).
int normal_sign(const Point& a, const Point& b, const Point& c, unsigned axis) noexcept;

/// Side of a triangle's plane that `point` is on once moved by an infinitesimal
/// step (see PerturbedSegment): 0 only where the triangle has no area.
int perturbed_side(const Triangle& triangle, const Point& point) noexcept;

/// Whether `point` is on the closed triangle, which may be a segment or a point.
bool lies_on(const Point& point, const Triangle& triangle) noexcept;

/// The segment between two points moved by infinitesimal steps, so that no
/// vertex, edge or face is ever met edge-on: from + (e1, e2, e3) and
/// to + (d1, d2, d3), e1 >> e2 >> e3 >> d1 >> d2 >> d3 > 0, each beyond every
/// power of the next (simulation of simplicity, Edelsbrunner & Muecke 1990).
/// A point has one step whatever the segment is, up to its length; so winding
/// numbers counted along different segments agree.
struct PerturbedSegment {
  Point from, to;
};

/// How the winding number changes on the way along `segment` because of one
/// triangle: from `to` back to `from`, so that
///
///     winding(from) = winding(to) + sum of crossing() over all triangles.
///
/// 1 or -1 where the segment passes through the triangle: 1 if `from` is behind
/// it, as seen along its normal (b - a) x (c - a). A triangle without area is
/// never crossed.
int crossing(const PerturbedSegment& segment, const Triangle& triangle) noexcept;

}  // namespace planetree::octree
