#pragma once

#include <cstdint>
#include <limits>

#include "planetree/types.h"

/// @file
/// Values that queries for rays and for moving balls take and return. Units and axes as in types.h.

namespace planetree {

/// The points origin + t * direction with t_min <= t <= t_max. The direction may have any length
/// but zero; it is taken as it is, without rounding. (Components smaller than about 2^-1000 times
/// the largest are rounded, and so are coordinates of the origin smaller than 2^-1022 times the
/// size of the model. Hits are told apart from the ends of the ray if they are 2^-1020 times that
/// size away.)
struct Ray {
  Vec3 origin;                                             ///< model units
  Vec3 direction;                                          ///< model units for each unit of t
  double t_min = 0;                                        ///< >= 0
  double t_max = std::numeric_limits<double>::infinity();  ///< >= t_min, may be infinite
};

/// A point where a ray passes through a triangle.
///
/// Whether a ray passes through a triangle is decided exactly, for a ray moved by an infinitesimal
/// step. So a ray through an edge or a vertex of a closed surface passes through exactly one of the
/// triangles there where it enters or leaves the solid, and through none or through two where it
/// touches the surface from one side. A ray in the plane of a triangle does not pass through it. No
/// ray passes through a triangle without area.
struct RayHit {
  double t = std::numeric_limits<double>::infinity();  ///< infinite if there is no hit
  /// Certified: the ray certainly passes through no triangle before t_lower. If the status is
  /// kExact, the true t of the first hit is in [t_lower, t_upper]. Infinite if there is no hit.
  double t_lower = std::numeric_limits<double>::infinity();
  double t_upper = std::numeric_limits<double>::infinity();  ///< see t_lower
  Vec3 point;                                                ///< the point, on the triangle
  Vec3 normal{0, 0, 1};                  ///< unit normal of the triangle, as the mesh orients it
  std::uint64_t triangle = kNoTriangle;  ///< as ClosestPoint::triangle
  Vec3 barycentric;                      ///< as ClosestPoint::barycentric
  bool entering = false;                 ///< the ray goes against the triangle's normal
  Status status = Status::kBadQuery;     ///< see Probe::first_hit
};

/// The motion of a ball: its centre goes straight from `from` to `to` while t goes from 0 to 1.
struct Sweep {
  Vec3 from,          ///< centre at t = 0, model units
      to;             ///< centre at t = 1, model units
  double radius = 0;  ///< model units, >= 0; 0: a point
};

/// The first contact of a moving ball with the surface.
struct FirstContact {
  /// Least t in [0, 1] at which the ball touches the surface, as computed. Up to it no triangle
  /// that was read is touched. Infinite if no contact was found.
  double t = std::numeric_limits<double>::infinity();
  /// Certified, for every status: before t_lower the ball touches nothing. Infinite if the whole
  /// motion is free. 1 at most if it is not known to be.
  double t_lower = 0;
  /// Certified: by t_upper the ball has touched the surface. Infinite if that is not certain, as
  /// where the ball grazes the surface within rounding.
  double t_upper = std::numeric_limits<double>::infinity();
  /// The contact: triangle, feature, barycentric, and the surface point nearest to the centre at
  /// `t` with its distance. The normal points from that point to the centre; if they coincide, it
  /// is the triangle's normal against the motion. The side is kUnknown.
  ClosestPoint at;
  bool free = false;                  ///< certainly no contact in all of the motion
  Status status = Status::kBadQuery;  ///< see Probe::first_contact
};

}  // namespace planetree
