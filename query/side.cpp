#include "query/side.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "octree/clipped_grid.h"
#include "octree/crossings.h"
#include "octree/mask_lookup.h"
#include "octree/nearest.h"
#include "octree/strict_math.h"
#include "octree/winding_number.h"
#include "query/ways_out.h"

namespace planetree::query {
namespace {

using octree::Point;

/// One search for the side of a point, and what it may still spend.
class SideSearch {
 public:
  SideSearch(const ModelState& model, const Point& point, std::uint64_t max_nodes,
             octree::PageReader pages, octree::TreeWork& work, SideReason* reason,
             SideMemory* memory)
      : model_(model),
        point_(point),
        max_nodes_(max_nodes),
        pages_(pages),
        work_(work),
        reason_(reason),
        memory_(memory),
        before_(work.nodes + work.blocks) {}

  Standing run() {
    if (ask_mask()) return standing_;
    // Usually the first way tells; another may do without a page that is lost.
    const octree::Region& region = model_.region();
    const WaysOut ways(model_.tree(), point_);
    for (const WaysOut::Way& way : ways.all())
      if (region.holds(way.end) && go(way.end, 0, SideReason::Rule::kWayOut)) return standing_;
    if (region.has_walls() &&
        go(model_.region_corner(), model_.region_winding(), SideReason::Rule::kWayOut))
      return standing_;
    return {Side::kUnknown, Status::kDegraded};
  }

  // Whether the winding number itself is known, not its sign alone.
  bool counted() const { return counted_; }

 private:
  std::uint64_t nodes_left() const {
    const std::uint64_t spent = work_.nodes + work_.blocks - before_;
    return spent < max_nodes_ ? max_nodes_ - spent : 0;
  }

  bool ask_mask() {
    using Kind = octree::MaskFinding::Kind;
    const octree::MaskFinding& found = cell();
    if (reason_) {
      reason_->in_mask = model_.mask().page_count > 0;
      reason_->cell = found.cell;
    }
    if (found.kind == Kind::kCorners) return go_to_corner(found);
    if (found.kind == Kind::kNothing) return false;
    if (reason_)
      reason_->rule =
          found.kind == Kind::kColour ? SideReason::Rule::kColour : SideReason::Rule::kPlanes;
    counted_ = found.kind == Kind::kPlanes || found.winding == 0;
    settle(found.winding, found.on_surface);
    return true;
  }

  const octree::MaskFinding& cell() {
    if (memory_)
      if (const octree::MaskFinding* last = memory_->cell_with(point_)) return *last;
    // What is resident, answers that remember depend on anyway.
    found_ = memory_ ? octree::look_up(model_.mask(), model_.colours(), point_, nodes_left(),
                                       pages_, work_)
                     : octree::look_up(model_.mask(), point_, nodes_left(), pages_, work_);
    // What a special cell knows is of this point alone.
    const bool of_all = found_.kind == octree::MaskFinding::Kind::kColour ||
                        found_.kind == octree::MaskFinding::Kind::kCorners;
    if (memory_ && of_all && memory_->is_near(point_, model_.tree()))
      memory_->note_cell(model_.mask(), found_);
    return found_;
  }

  // The nearest corner, or the last point if that is nearer: few triangles are between.
  bool go_to_corner(const octree::MaskFinding& found) {
    const octree::ClippedGrid grid(model_.mask().lower, model_.region());
    Point corner = grid.lower(found.cell);
    const Point upper = grid.upper(found.cell);
    unsigned nearest = 0;
    for (unsigned axis = 0; axis < 3; ++axis) {
      const bool is_upper = point_[axis] - corner[axis] > upper[axis] - point_[axis];
      if (is_upper) corner[axis] = upper[axis];
      nearest |= static_cast<unsigned>(is_upper) << axis;
    }
    if (memory_ && memory_->counted() &&
        (memory_->point() - point_).squaredNorm() < (corner - point_).squaredNorm() &&
        go(memory_->point(), memory_->standing().winding, SideReason::Rule::kCorner))
      return true;
    return go(corner, found.corners[nearest], SideReason::Rule::kCorner);
  }

  // To where the winding number is known. False if that way cannot be gone.
  bool go(const Point& end, std::int64_t winding, SideReason::Rule rule) {
    if (nodes_left() == 0) return false;
    const octree::Crossings crossings =
        octree::count_crossings(model_.tree(), {point_, end}, nodes_left(), pages_, work_);
    if (!crossings.complete) return false;
    if (reason_) {
      reason_->rule = rule;
      reason_->end = end;
      reason_->known = winding;
      reason_->crossings = crossings.difference;
    }
    counted_ = true;
    settle(winding + crossings.difference, crossings.on_surface);
    return true;
  }

  void settle(std::int64_t winding, bool on_surface) {
    const Side off_surface = winding != 0 ? Side::kInside : Side::kOutside;
    standing_ = {on_surface ? Side::kOnSurface : off_surface, Status::kExact, winding};
  }

  const ModelState& model_;
  const Point& point_;
  const std::uint64_t max_nodes_;
  const octree::PageReader pages_;
  octree::TreeWork& work_;
  SideReason* const reason_;  // null where nobody asks why
  SideMemory* const memory_;  // null where nothing is remembered
  const std::uint64_t before_;
  octree::MaskFinding found_;
  Standing standing_;
  bool counted_ = false;
};

Standing by_crossings(const ModelState& model, const Point& point, std::uint64_t max_nodes,
                      octree::PageReader pages, octree::TreeWork& work, SideReason* reason) {
  if (outside_box(model.tree(), point)) {
    if (reason) reason->rule = SideReason::Rule::kOutsideBox;
    return {Side::kOutside};
  }
  return SideSearch(model, point, max_nodes, pages, work, reason, nullptr).run();
}

// What is left out of a file may change the winding number: of a point beyond a wall of its
// region, and of any where winding numbers are not constant off the surface.
bool is_untold(const ModelState& model, const Point& point) {
  const octree::Region& region = model.region();
  return region.has_walls() && (!region.holds(point) || !model.info().watertight());
}

/// The nearest whole number, however large.
std::int64_t rounded(double value) {
  constexpr double kMost = 0x1p62;
  return static_cast<std::int64_t>(std::clamp(value + (value < 0 ? -0.5 : 0.5), -kMost, kMost));
}

Standing by_winding_number(const octree::TreeFacts& tree, const Point& point,
                           std::uint64_t max_nodes, octree::PageReader pages,
                           octree::TreeWork& work, SideReason* reason) {
  if (reason) reason->rule = SideReason::Rule::kWindingNumber;
  // From so far away all triangles together are less than a point.
  if (!(point.cwiseAbs().maxCoeff() <= octree::kFarthestQuery)) return {Side::kOutside};
  const octree::WindingNumber w = octree::winding_number(tree, point, max_nodes, pages, work);
  if (reason) {
    reason->value = w.value;
    reason->error = w.error;
  }
  if (w.on_surface) {
    const bool told = std::fabs(w.value) > w.error;
    return {Side::kOnSurface, Status::kExact, told ? (w.value < 0 ? -1 : 1) : 0, false};
  }
  if (w.above_half()) return {Side::kInside, Status::kExact, rounded(w.value)};
  if (w.below_half()) return {Side::kOutside, Status::kExact};
  return {Side::kUnknown, w.complete ? Status::kExact : Status::kDegraded};
}

}  // namespace

Standing find_side(const ModelState& model, const Point& point, std::uint64_t max_nodes,
                   octree::PageReader pages, octree::TreeWork& work, SideReason* reason) noexcept {
  if (reason) *reason = {};
  if (is_untold(model, point)) {
    if (reason) reason->rule = SideReason::Rule::kRegion;
    return {};
  }
  return model.info().watertight()
             ? by_crossings(model, point, max_nodes, pages, work, reason)
             : by_winding_number(model.tree(), point, max_nodes, pages, work, reason);
}

std::optional<Standing> side_at_once(const ModelState& model, const Point& point) noexcept {
  if (is_untold(model, point)) return Standing{};
  // Models that are not watertight have no colours.
  const int winding = model.colours().winding(point);
  if (winding != octree::ColourMap::kUnknown)
    return Standing{winding != 0 ? Side::kInside : Side::kOutside, Status::kExact, winding};
  if (model.info().watertight() && outside_box(model.tree(), point))
    return Standing{Side::kOutside};
  return {};
}

std::optional<Standing> side_as_before(const ModelState& model, const Point& point, double clear,
                                       SideMemory& memory) noexcept {
  if (!model.region().holds(point) || !memory.same_side(point, clear)) return {};
  memory.note(point, memory.standing(), memory.counted(), clear);
  return memory.standing();
}

Standing find_side(const ModelState& model, const Point& point, double clear, SideMemory& memory,
                   std::uint64_t max_nodes, octree::PageReader pages,
                   octree::TreeWork& work) noexcept {
  if (!model.info().watertight() || !model.region().holds(point) ||
      outside_box(model.tree(), point))
    return find_side(model, point, max_nodes, pages, work);
  if (const auto before = side_as_before(model, point, clear, memory)) return *before;
  SideSearch search(model, point, max_nodes, pages, work, nullptr, &memory);
  const Standing standing = search.run();
  if (standing.status == Status::kExact) memory.note(point, standing, search.counted(), clear);
  return standing;
}

}  // namespace planetree::query
