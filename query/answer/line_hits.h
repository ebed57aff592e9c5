#pragma once

#include <span>

#include "planetree/contact.h"
#include "query/answer/model_line.h"
#include "query/answer/query_context.h"

namespace planetree::query {

/// The triangles that a straight way passes through.
struct LineHits {
  Found found;
  /// Bounds on the position of the first hit; infinite if there is none. Before `lower` nothing is
  /// hit, whatever was not read.
  double lower, upper;
  bool is_degraded = false;    ///< some may lack, because pages or work did
  octree::Triangle corners{};  ///< of the only hit, if one is kept; model frame
};

/// Writes the first triangles that a way passes through to `hits`, as Probe::all_hits() states.
///
/// wants_all  whether to find out if there are more than fit
/// options    returned by with_defaults(); is_valid() holds for them and for the way
LineHits find_hits(const QueryContext& context, const ModelLine& way, bool wants_all,
                   const QueryOptions& options, std::span<RayHit> hits) noexcept;

/// Returns how far from a way another one may be, at each position, so that it certainly passes
/// through a triangle that the way passes through, and within twice that distance over the cosine
/// of the angle to the normal. Lengths are in the frame of the corners. It is 0 unless the crossing
/// is well inside of a triangle that is not thin: what is computed here then errs by far less than
/// what it is compared with.
///
/// barycentric  of the crossing
/// cosine       of the angle between way and normal, its magnitude
double crossing_tolerance(const octree::Triangle& corners, const Vec3& barycentric,
                          double cosine) noexcept;

/// The first hit, with what a moved ray needs to know.
struct FirstHit {
  RayHit hit;
  bool is_degraded = false;    ///< pages or work lacked
  octree::Triangle corners{};  ///< of the triangle, if one is hit; model frame
};

/// See Probe::first_hit. The rules of find_hits() apply.
FirstHit first_hit(const QueryContext& context, ModelLine way,
                   const QueryOptions& options) noexcept;

}  // namespace planetree::query
