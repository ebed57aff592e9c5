#include "tools/check/mask_proof.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "octree/builder/mask/block_lister.h"
#include "octree/builder/mask/special_cell.h"
#include "octree/geometry/cell_overlap.h"
#include "octree/geometry/strict_math.h"
#include "octree/mask/mask_lookup.h"
#include "octree/traversal/link_resolver.h"
#include "octree/traversal/tree_view.h"
#include "octree/traversal/tree_walk.h"
#include "octree/winding/crossings.h"
#include "query/answer/side_search.h"
#include "query/serve/page_accessor.h"

namespace planetree::tools {
namespace {

using octree::GridCell;
using octree::Point;
using octree::Triangle;

constexpr std::uint64_t kAllNodes = ~std::uint64_t{0};

std::string cell_name(const GridCell& cell) {
  return fmt::format("{}/{}/{}/{}", cell.level, cell.at[0], cell.at[1], cell.at[2]);
}

/// A key of a corner, equal for all cells that share the corner.
std::uint64_t corner_key(const GridCell& cell, unsigned corner) {
  std::uint64_t key = 0;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const std::uint64_t index = cell.at[axis] + (corner >> axis & 1);
    key = key << 20 | index << (octree::kLevels - cell.level);
  }
  return key;
}

octree::SpecialCell claim_of(const GreyCell& grey) {
  octree::SpecialCell claim;
  claim.plane_count = grey.special->plane_count;
  claim.behind = grey.special->behind;
  claim.beyond = grey.special->beyond;
  for (unsigned i = 0; i < claim.plane_count; ++i)
    claim.planes[i] = octree::mask_plane(grey.planes, i);
  return claim;
}

// Whether `said` lists all blocks and octants of `found`. It may list more.
bool has_all(const octree::MaskBlocks& stated, const octree::MaskBlocks& found) {
  for (unsigned i = 0; i < found.count; ++i) {
    unsigned octants = 0;
    for (unsigned k = 0; k < stated.count; ++k)
      if (stated.links[k] == found.links[i]) octants = stated.octants[k];
    if ((found.octants[i] & ~octants) != 0) return false;
  }
  return true;
}

using Polygon = std::vector<Point>;

/// Allowed rounding, as a share of a step, which is 1/256 of CellSlab::width().
constexpr double kRounding = 0x1p-20;

// Clips a polygon to the half space `sign` * (x[axis] - at) >= 0 (Sutherland and Hodgman 1974).
Polygon clipped(const Polygon& polygon, unsigned axis, double at, double sign) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
    const double here = sign * (from[axis] - at), there = sign * (to[axis] - at);
    if (here >= 0) kept.push_back(from);
    if ((here < 0) != (there < 0)) kept.push_back(from + (to - from) * (here / (here - there)));
  }
  return kept;
}

// Whether the part of a triangle within a cell, of these corners, is within the cell's slab, up to
// rounding.
bool is_part_within_slab(const octree::CellSlab& slab, const octree::Triangle& triangle,
                         const octree::Point& lower, const octree::Point& upper, unsigned level) {
  const double step = slab.width() / 256.0, rounding = kRounding * step;
  const double least = (slab.lower + 0.5) * step, greatest = (slab.upper + 0.5) * step;
  const auto is_within = [&](const Point& at) {
    const double height = slab.height(at);
    return (slab.lower == octree::CellSlab::kNoLower || height >= least - rounding) &&
           (slab.upper == octree::CellSlab::kNoUpper || height <= greatest + rounding);
  };
  Polygon polygon;
  for (const Point& corner : triangle)
    polygon.push_back(octree::CellSlab::position_in(corner, lower, level));
  // In most cases all corners are within, and nothing need be clipped.
  if (std::all_of(polygon.begin(), polygon.end(), is_within)) return true;
  const Point end = octree::CellSlab::position_in(upper, lower, level);
  for (unsigned axis = 0; axis < 3; ++axis) {
    polygon = clipped(polygon, axis, 0, 1);
    polygon = clipped(polygon, axis, end[axis], -1);
  }
  return std::all_of(polygon.begin(), polygon.end(), is_within);
}

}  // namespace

Result<std::unique_ptr<MaskProof>> MaskProof::open(const std::filesystem::path& path,
                                                   IssueList& issues) {
  auto opened = ModelReader::open(path);
  if (!opened) return opened.error();
  return std::unique_ptr<MaskProof>(new MaskProof(*std::move(opened), issues));
}

MaskProof::MaskProof(ModelReader opened, IssueList& issues)
    : model_(std::move(opened.model)),
      reader_(std::move(opened.reader)),
      issues_(issues),
      grid_(model_->geometry().mask.lower, model_->geometry().region) {}

void MaskProof::check_cell(const GreyCell& grey) {
  if (grey.node != nullptr) check_octants(grey);
  if (grey.corners != nullptr) check_corners(grey, *grey.corners);
  if (grey.listed != nullptr) {
    octree::MaskCorners corners;
    for (unsigned corner = 0; corner < 8; ++corner)
      corners[corner] = static_cast<std::int8_t>(octree::corner_number(*grey.listed, corner));
    check_corners(grey, corners);
    check_list(grey);
  }
  if (grey.special != nullptr) check_special(grey);
}

void MaskProof::check_octants(const GreyCell& grey) {
  for (unsigned octant = 0; octant < 8; ++octant)
    if (!grey.node->is_grey(octant))
      check_colour(grey.page, grey.cell.child(octant), grey.node->winding(octant));
}

void MaskProof::check_colour(std::uint32_t page, const GridCell& cell, int colour) {
  constexpr std::array<const char*, 3> kNames = {"inverted", "white", "black"};
  const char* name = kNames[static_cast<std::size_t>(colour + 1)];
  if (!grid_.has_part_of(cell)) {
    if (colour != 0)
      report(IssueCode::kMaskColour, page,
             fmt::format("cell {} is {}, but it is outside of the region", cell_name(cell), name));
    return;
  }
  if (!triangles_touching(cell).empty() || !caps_touching(cell).empty())
    return report(IssueCode::kMaskColour, page,
                  fmt::format("cell {} is {}, but triangles touch it", cell_name(cell), name));
  const std::optional<std::int64_t> number = winding(cell, 0);
  if (number && (*number > 0) - (*number < 0) != colour)
    report(
        IssueCode::kMaskColour, page,
        fmt::format("cell {} is {}, but its winding number is {}", cell_name(cell), name, *number));
}

void MaskProof::check_corners(const GreyCell& grey, const octree::MaskCorners& corners) {
  if (corners[0] == octree::kUncounted) return;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const int stated = corners[corner];
    const std::optional<std::int64_t> number = winding(grey.cell, corner);
    if (number && *number != stated)
      report(IssueCode::kMaskCorner, grey.page,
             fmt::format("the winding number at corner {} of cell {} is {}, not {}", corner,
                         cell_name(grey.cell), *number, stated));
  }
}

void MaskProof::check_list(const GreyCell& grey) {
  if (grey.cell.level == octree::kLevels) return;
  query::PageAccessor accessor(reader_, Wait::kForPages);
  octree::MaskBlocks found;
  const octree::BlockLister lister(model_->geometry().tree, grid_);
  const auto outcome = lister.list(grey.cell, accessor.pages(), found);
  if (outcome == octree::BlockLister::Outcome::kLost) return;
  const bool all = outcome == octree::BlockLister::Outcome::kListed;
  if (!all || !has_all(grey.blocks, found))
    report(IssueCode::kMaskBlocks, grey.page,
           fmt::format("cell {} does not list all blocks that touch it", cell_name(grey.cell)));
  octree::LinkResolver records(model_->geometry().tree, accessor.pages());
  octree::TraversalStats work;
  if (model_->geometry().region.has_walls() && grey.blocks.slab.has_plane())
    report(IssueCode::kMaskSlab, grey.page,
           fmt::format("cell {} has a slab, but the region has walls", cell_name(grey.cell)));
  bool outside = false;
  for (unsigned i = 0; i < grey.blocks.count; ++i) {
    const std::uint32_t link = grey.blocks.links[i];
    const auto links = octree::LinkFormat::numbered(model_->geometry().tree.page_bytes);
    // An unreadable page is reported elsewhere.
    if (const std::byte* record = records.find_numbered(link, work))
      outside = outside ||
                !is_within_slab(grey, octree::BlockView(record, model_->geometry().tree.shape));
    else if (accessor.peek(links.page(link)) != nullptr)
      report(IssueCode::kMaskBlocks, grey.page,
             fmt::format("cell {} lists a link that leads to no block", cell_name(grey.cell)));
  }
  if (outside)
    report(IssueCode::kMaskSlab, grey.page,
           fmt::format("the surface in cell {} is not between its slab's planes",
                       cell_name(grey.cell)));
}

// Checks a block that the cell lists.
bool MaskProof::is_within_slab(const GreyCell& grey, const octree::BlockView& block) const {
  const octree::CellSlab& slab = grey.blocks.slab;
  if (!slab.has_plane()) return true;
  const Point lower = grid_.lower(grey.cell), upper = grid_.upper(grey.cell);
  for (unsigned i = 0; i < block.triangle_count(); ++i)
    if (!is_part_within_slab(slab, block.triangle(i), lower, upper, grey.cell.level)) return false;
  return true;
}

void MaskProof::check_special(const GreyCell& grey) {
  std::array<Point, 8> corners;
  std::array<std::int64_t, 8> numbers{};
  for (unsigned corner = 0; corner < 8; ++corner) {
    corners[corner] = grid_.corner(grey.cell, corner);
    const std::optional<std::int64_t> number = winding(grey.cell, corner);
    if (!number) return;
    numbers[corner] = *number;
  }
  if (!caps_touching(grey.cell).empty() ||
      !octree::is_special_cell(claim_of(grey), triangles_touching(grey.cell), corners, numbers))
    report(IssueCode::kMaskPlanes, grey.page,
           fmt::format("the planes of cell {} do not describe which part of it is inside",
                       cell_name(grey.cell)));
}

std::optional<std::int64_t> MaskProof::winding(const GridCell& cell, unsigned corner) {
  const auto [position, added] = counted_.try_emplace(corner_key(cell, corner));
  if (added) position->second = count_winding(grid_.corner(cell, corner));
  return position->second;
}

std::optional<std::int64_t> MaskProof::count_winding(const Point& point) {
  const octree::TreeInfo& tree = model_->geometry().tree;
  if (query::outside_box(tree, point)) return 0;
  if (model_->geometry().region.has_walls()) return count_along_walls(point);
  query::PageAccessor accessor(reader_, Wait::kForPages);
  octree::TraversalStats work;
  const query::ExitSegments segments(tree, point);
  for (const query::ExitSegments::Segment& segment : segments.all()) {
    const octree::Crossings crossings =
        octree::count_crossings(tree, {point, segment.end}, kAllNodes, accessor.pages(), work);
    if (crossings.complete) return crossings.difference;
  }
  return std::nullopt;
}

std::optional<std::int64_t> MaskProof::count_along_walls(const Point& point) {
  const query::ModelGeometry& model = model_->geometry();
  Point end = model.region_corner;
  std::int64_t number = model.region_winding;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double lower = model.tree.box_lower[axis], upper = model.tree.box_upper[axis];
    if (!std::isinf(model.region.lower()[axis]) && !std::isinf(model.region.upper()[axis]))
      continue;
    end = point;
    end[axis] = std::isinf(model.region.upper()[axis]) ? upper + 1 + std::fabs(upper)
                                                       : lower - 1 - std::fabs(lower);
    number = 0;
  }
  query::PageAccessor accessor(reader_, Wait::kForPages);
  octree::TraversalStats work;
  const octree::Crossings crossings =
      octree::count_crossings(model.tree, {point, end}, kAllNodes, accessor.pages(), work);
  if (!crossings.complete) return std::nullopt;
  return number + crossings.difference;
}

bool MaskProof::check_region() {
  const std::optional<std::int64_t> number = count_along_walls(grid_.corner(GridCell{}, 0));
  const std::int64_t stated = model_->geometry().region_winding;
  if (!number || *number == stated) return true;
  report(IssueCode::kRegion, 0,
         fmt::format("the winding number at the region's first corner is {}, not {}; build the "
                     "file again",
                     *number, stated));
  return false;
}

std::vector<Triangle> MaskProof::caps_touching(const GridCell& cell) {
  const octree::TreeInfo* caps = model_->geometry().tree.caps;
  return caps ? triangles_touching(cell, *caps) : std::vector<Triangle>();
}

std::vector<Triangle> MaskProof::triangles_touching(const GridCell& cell) {
  return triangles_touching(cell, model_->geometry().tree);
}

std::vector<Triangle> MaskProof::triangles_touching(const GridCell& cell,
                                                    const octree::TreeInfo& tree) {
  const Point lower = grid_.lower(cell), upper = grid_.upper(cell);
  query::PageAccessor accessor(reader_, Wait::kForPages);
  octree::TraversalStats work;
  std::vector<Triangle> found;
  octree::BoxWalk(tree, lower, upper, accessor.pages(), work)
      .run(kAllNodes, [&](const octree::BlockView& block, std::uint32_t) {
        for (unsigned i = 0; i < block.triangle_count(); ++i)
          if (const Triangle triangle = block.triangle(i);
              octree::may_touch(triangle, lower, upper))
            found.push_back(triangle);
      });
  return found;
}

void MaskProof::report(IssueCode code, std::uint32_t page, std::string message) {
  issues_.add({code, page, Error::kNowhere, std::move(message)});
}

}  // namespace planetree::tools
