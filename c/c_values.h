#pragma once

#include <cstddef>
#include <cstdint>

#include "planetree/attributes.h"
#include "planetree/c.h"
#include "planetree/contact.h"
#include "planetree/error.h"
#include "planetree/types.h"

/// Values of the C interface as those of the library. Structs of both have the same layout, which
/// the assertions here check: answers are written where the caller wants them, without a copy. If a
/// struct of the library changes, that of the C interface stays, and answers are copied.
namespace planetree::c {

static_assert(sizeof(Vec3) == 3 * sizeof(double) && alignof(Vec3) == alignof(double));

template <class Theirs, class Ours>
constexpr bool kHaveOneSize = sizeof(Theirs) == sizeof(Ours) && alignof(Theirs) == alignof(Ours);

static_assert(kHaveOneSize<planetree_closest_point, ClosestPoint>);
static_assert(offsetof(planetree_closest_point, upper) == offsetof(ClosestPoint, upper));
static_assert(offsetof(planetree_closest_point, side) == offsetof(ClosestPoint, side));
static_assert(offsetof(planetree_closest_point, point) == offsetof(ClosestPoint, point));
static_assert(offsetof(planetree_closest_point, normal) == offsetof(ClosestPoint, normal));
static_assert(offsetof(planetree_closest_point, triangle) == offsetof(ClosestPoint, triangle));
static_assert(offsetof(planetree_closest_point, barycentric) ==
              offsetof(ClosestPoint, barycentric));
static_assert(offsetof(planetree_closest_point, feature) == offsetof(ClosestPoint, feature));
static_assert(offsetof(planetree_closest_point, status) == offsetof(ClosestPoint, status));

static_assert(kHaveOneSize<planetree_hit, RayHit>);
static_assert(offsetof(planetree_hit, t_upper) == offsetof(RayHit, t_upper));
static_assert(offsetof(planetree_hit, point) == offsetof(RayHit, point));
static_assert(offsetof(planetree_hit, normal) == offsetof(RayHit, normal));
static_assert(offsetof(planetree_hit, triangle) == offsetof(RayHit, triangle));
static_assert(offsetof(planetree_hit, barycentric) == offsetof(RayHit, barycentric));
static_assert(offsetof(planetree_hit, entering) == offsetof(RayHit, entering));
static_assert(offsetof(planetree_hit, status) == offsetof(RayHit, status));

static_assert(kHaveOneSize<planetree_first_contact, FirstContact>);
static_assert(offsetof(planetree_first_contact, t_upper) == offsetof(FirstContact, t_upper));
static_assert(offsetof(planetree_first_contact, at) == offsetof(FirstContact, at));
static_assert(offsetof(planetree_first_contact, free) == offsetof(FirstContact, free));
static_assert(offsetof(planetree_first_contact, status) == offsetof(FirstContact, status));

static_assert(kHaveOneSize<planetree_ray, Ray>);
static_assert(offsetof(planetree_ray, direction) == offsetof(Ray, direction));
static_assert(offsetof(planetree_ray, t_max) == offsetof(Ray, t_max));
static_assert(kHaveOneSize<planetree_sweep, Sweep>);
static_assert(offsetof(planetree_sweep, radius) == offsetof(Sweep, radius));

static_assert(kHaveOneSize<planetree_triangle, MeshTriangle>);
static_assert(offsetof(planetree_triangle, colors) == offsetof(MeshTriangle, colors));
static_assert(offsetof(planetree_triangle, uvs) == offsetof(MeshTriangle, uvs));
static_assert(offsetof(planetree_triangle, value) == offsetof(MeshTriangle, value));

/// Return what the caller of the C interface sees as one of its structs.
inline ClosestPoint& written(planetree_closest_point* answer) {
  return *reinterpret_cast<ClosestPoint*>(answer);
}
inline RayHit& written(planetree_hit* hit) { return *reinterpret_cast<RayHit*>(hit); }
inline FirstContact& written(planetree_first_contact* contact) {
  return *reinterpret_cast<FirstContact*>(contact);
}
inline MeshTriangle& written(planetree_triangle* triangle) {
  return *reinterpret_cast<MeshTriangle*>(triangle);
}
inline const Ray* read(const planetree_ray* ray) { return reinterpret_cast<const Ray*>(ray); }
inline const Sweep* read(const planetree_sweep* sweep) {
  return reinterpret_cast<const Sweep*>(sweep);
}

inline planetree_found found(const Found& set) { return {set.count, set.complete}; }

/// Whether the caller had the defaults of options set, so that all members have values.
template <class Options>
bool are_set(const Options* given) {
  return !given || given->struct_bytes >= sizeof *given;
}

/// Returns the options of a query; null: the defaults. With options that are not set, every query
/// is Status::kBadQuery.
QueryOptions options_of(const planetree_query_options* given);

/// Reports a failure and returns its code. `to` may be null.
std::uint32_t fail(const Error& error, planetree_error* to);
std::uint32_t fail_without_memory(planetree_error* to);
std::uint32_t fail_for_unset_options(planetree_error* to);

}  // namespace planetree::c
