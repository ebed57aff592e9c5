#pragma once

#include "planetree/contact.h"
#include "query/answer/query_context.h"

namespace planetree::query {

/// See Probe::first_contact.
///
/// sweep        is_valid() holds
/// options      returned by with_defaults(); is_valid() holds
/// is_degraded  receives whether pages or work lacked
FirstContact first_contact(const QueryContext& context, const Sweep& sweep,
                           const QueryOptions& options, bool& is_degraded) noexcept;

}  // namespace planetree::query
