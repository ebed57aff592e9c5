#pragma once

#include <cstdint>
#include <limits>

#include "planetree/contact.h"
#include "planetree/types.h"
#include "python/fields.h"

namespace planetree::python {

/// Columns of closest points.
inline constexpr Field<ClosestPoint> kClosestPointFields[] = {
    field<ClosestPoint, [](const ClosestPoint& a) { return a.distance; }>("distance", 'd'),
    field<ClosestPoint, [](const ClosestPoint& a) { return a.signed_distance(); }>(
        "signed_distance", 'd'),
    field<ClosestPoint, [](const ClosestPoint& a) { return a.lower; }>("lower", 'd'),
    field<ClosestPoint, [](const ClosestPoint& a) { return a.upper; }>("upper", 'd'),
    field<ClosestPoint, [](const ClosestPoint& a) { return a.side; }>("side", 'B'),
    field<ClosestPoint, [](const ClosestPoint& a) { return a.point; }>("points", 'd', 3),
    field<ClosestPoint, [](const ClosestPoint& a) { return a.normal; }>("normals", 'd', 3),
    field<ClosestPoint, [](const ClosestPoint& a) { return a.triangle; }>("triangles", 'L'),
    field<ClosestPoint, [](const ClosestPoint& a) { return a.barycentric; }>("barycentric", 'd', 3),
    field<ClosestPoint, [](const ClosestPoint& a) { return a.feature; }>("feature", 'B'),
    field<ClosestPoint, [](const ClosestPoint& a) { return a.status; }>("status", 'B'),
};

/// Columns of hits of rays.
inline constexpr Field<RayHit> kRayHitFields[] = {
    field<RayHit, [](const RayHit& a) { return a.t; }>("t", 'd'),
    field<RayHit, [](const RayHit& a) { return a.t_lower; }>("t_lower", 'd'),
    field<RayHit, [](const RayHit& a) { return a.t_upper; }>("t_upper", 'd'),
    field<RayHit, [](const RayHit& a) { return a.point; }>("points", 'd', 3),
    field<RayHit, [](const RayHit& a) { return a.normal; }>("normals", 'd', 3),
    field<RayHit, [](const RayHit& a) { return a.triangle; }>("triangles", 'L'),
    field<RayHit, [](const RayHit& a) { return a.barycentric; }>("barycentric", 'd', 3),
    field<RayHit, [](const RayHit& a) { return std::uint8_t{a.entering}; }>("entering", 'B'),
    field<RayHit, [](const RayHit& a) { return a.status; }>("status", 'B'),
};

/// Columns of first contacts of moving balls.
inline constexpr Field<FirstContact> kFirstContactFields[] = {
    field<FirstContact, [](const FirstContact& a) { return a.t; }>("t", 'd'),
    field<FirstContact, [](const FirstContact& a) { return a.t_lower; }>("t_lower", 'd'),
    field<FirstContact, [](const FirstContact& a) { return a.t_upper; }>("t_upper", 'd'),
    field<FirstContact, [](const FirstContact& a) { return std::uint8_t{a.free}; }>("free", 'B'),
    field<FirstContact, [](const FirstContact& a) { return a.at.point; }>("points", 'd', 3),
    field<FirstContact, [](const FirstContact& a) { return a.at.normal; }>("normals", 'd', 3),
    field<FirstContact, [](const FirstContact& a) { return a.at.triangle; }>("triangles", 'L'),
    field<FirstContact, [](const FirstContact& a) { return a.at.barycentric; }>("barycentric", 'd',
                                                                                3),
    field<FirstContact, [](const FirstContact& a) { return a.at.feature; }>("feature", 'B'),
    field<FirstContact, [](const FirstContact& a) { return a.status; }>("status", 'B'),
};

/// Columns of sides.
inline constexpr Field<Containment> kContainmentFields[] = {
    field<Containment, [](const Containment& a) { return a.side; }>("side", 'B'),
    field<Containment, [](const Containment& a) { return a.status; }>("status", 'B'),
};

}  // namespace planetree::python
