#pragma once

#include "planetree/point_shell.h"
#include "query/shell/shell_memory.h"
#include "query/shell/shell_query.h"

namespace planetree::query {

/// Returns the wrench of a model on the tool, in the model's frame. Leaves the points that may be
/// in contact in ShellMemory::hits, in the order of their numbers.
///
/// memory   of the same model as in earlier calls, or nothing is known in it
/// options  is_valid() holds
Wrench shell_wrench(ShellSource& source, ShellMemory& memory, const ToolPlace& place,
                    const ShellOptions& options);

/// Returns a hit as callers see it.
ShellContact contact_of(const ShellHit& hit, const SphereTree& tree);

}  // namespace planetree::query
