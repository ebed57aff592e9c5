#include "octree/mask_lookup.h"

#include <algorithm>

#include "octree/mask_records.h"
#include "octree/octcode.h"
#include "octree/predicates.h"
#include "octree/strict_math.h"

namespace planetree::octree {
namespace {

/// Which side of a special cell's planes the point is on.
void ask_planes(const MaskSpecial& special, const double* planes, const Point& point,
                MaskFinding& finding) {
  bool beyond = false, moved_beyond = false, on_plane = false;
  for (unsigned i = 0; i < special.plane_count; ++i) {
    const Triangle plane = mask_plane(planes, i);
    const int side = orientation(plane[0], plane[1], plane[2], point);
    beyond = beyond || side > 0;
    on_plane = on_plane || side == 0;
    moved_beyond = moved_beyond || (side != 0 ? side : moved_side(plane, point)) > 0;
  }
  finding.kind = MaskFinding::Kind::kPlanes;
  finding.winding = moved_beyond ? int{special.beyond} : int{special.behind};
  finding.on_surface = on_plane && !beyond;
}

void read_leaf(const std::byte* record, const MaskRecords& records, const Point& point,
               MaskFinding& finding) {
  const auto& corners = *reinterpret_cast<const MaskCorners*>(record);
  if (is_special(corners)) {
    const auto& special = *reinterpret_cast<const MaskSpecial*>(record);
    const auto* planes = reinterpret_cast<const double*>(records.slot(special.plane_slot));
    ask_planes(special, planes, point, finding);
  } else if (corners[0] != kUncounted) {
    finding.kind = MaskFinding::Kind::kCorners;
    finding.corners = corners;
  }
}

}  // namespace

MaskFinding look_up(const MaskFacts& mask, const Point& point, std::uint64_t max_nodes,
                    PageReader pages, TreeWork& work) noexcept {
  MaskFinding finding;
  if (mask.page_count == 0 || max_nodes == 0) return finding;
  MaskRecords records(mask, pages);
  const std::byte* record = records.root(work);
  if (record && !records.root_is_node()) read_leaf(record, records, point, finding);
  if (!record || !records.root_is_node()) return finding;
  const GridCell finest = CellGrid(mask.lower).finest(point);
  const std::uint64_t octants = finest.first_code();
  // A forged mask could be deeper than cells can be told apart.
  const auto most = static_cast<unsigned>(std::min<std::uint64_t>(max_nodes, kLevels));
  unsigned level = 0;
  while (level < most) {
    ++work.nodes;
    const auto& node = *reinterpret_cast<const MaskNode*>(record);
    const auto octant = static_cast<unsigned>(octants >> 3 * (kLevels - ++level) & 7);
    if ((node.grey >> octant & 1) == 0) {
      finding.kind = MaskFinding::Kind::kColour;
      finding.winding = (node.black >> octant & 1) - (node.inverted >> octant & 1);
      break;
    }
    const bool leaf = (node.leaf >> octant & 1) != 0;  // the node goes with its page
    record = records.child(node, octant, work);
    if (!record) break;
    if (leaf) {
      read_leaf(record, records, point, finding);
      break;
    }
  }
  finding.cell = finest.ancestor(level);
  return finding;
}

}  // namespace planetree::octree
