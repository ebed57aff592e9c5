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
  bool is_degraded = false;  ///< some may lack, because pages or work did
};

/// Writes the first triangles that a way passes through to `hits`, as Probe::all_hits() states.
///
/// wants_all  whether to find out if there are more than fit
/// options    returned by with_defaults(); is_valid() holds for them and for the way
LineHits find_hits(const QueryContext& context, const ModelLine& way, bool wants_all,
                   const QueryOptions& options, std::span<RayHit> hits) noexcept;

/// See Probe::first_hit. The rules of find_hits() apply.
///
/// is_degraded  receives whether pages or work lacked
RayHit first_hit(const QueryContext& context, ModelLine way, const QueryOptions& options,
                 bool& is_degraded) noexcept;

}  // namespace planetree::query
