#include "query/shell/shell_wrench.h"

#include <algorithm>
#include <cmath>

#include "octree/geometry/strict_math.h"
#include "query/shell/wrench_sum.h"

namespace planetree::query {

Wrench shell_wrench(ShellSource& source, ShellMemory& memory, const ToolPlace& place,
                    const ShellOptions& options) {
  ShellQuery query(source, memory, place, options);
  query.run();

  // The sum does not depend on the order in which the points were found.
  const SphereTree& tree = memory.tree;
  std::ranges::sort(memory.hits, {},
                    [&tree](const ShellHit& hit) { return tree.points()[hit.point].number; });
  WrenchSum sum(tree, place, options);
  for (const ShellHit& hit : memory.hits) sum.add(hit);
  Wrench wrench;
  sum.finish(wrench);
  wrench.queries = query.queries();
  wrench.work = query.work();
  wrench.listed = memory.hits.size();
  const bool is_finite = std::isfinite(wrench.force_error) && std::isfinite(wrench.torque_error);
  wrench.status = wrench.undecided == 0 && is_finite ? Status::kExact : Status::kDegraded;
  return wrench;
}

ShellContact contact_of(const ShellHit& hit, const SphereTree& tree) {
  return {tree.points()[hit.point].number,
          hit.position,
          hit.direction,
          hit.depth,
          hit.depth_lower,
          hit.depth_upper,
          hit.is_proven ? Status::kExact : Status::kDegraded};
}

}  // namespace planetree::query
