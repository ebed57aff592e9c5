#include "query/answer/side.h"

#include <algorithm>
#include <cmath>

#include "octree/geometry/strict_math.h"
#include "octree/mask/mask_lookup.h"
#include "octree/nearest/nearest.h"
#include "octree/winding/winding_number.h"
#include "query/answer/exit_segments.h"
#include "query/answer/side_search.h"

namespace planetree::query {
namespace {

using octree::Point;

Standing by_crossings(const ModelState& model, const Point& point, std::uint64_t max_nodes,
                      const octree::PageReader& pages, octree::TreeWork& work, SideReason* reason) {
  if (outside_box(model.tree(), point)) {
    if (reason) reason->rule = SideReason::Rule::kOutsideBox;
    return {Side::kOutside};
  }
  return SideSearch(model, point, max_nodes, pages, work, reason).run();
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
                           std::uint64_t max_nodes, const octree::PageReader& pages,
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
                   const octree::PageReader& pages, octree::TreeWork& work,
                   SideReason* reason) noexcept {
  if (reason) *reason = {};
  if (is_untold(model, point)) {
    if (reason) reason->rule = SideReason::Rule::kRegion;
    return {};
  }
  return model.info().watertight()
             ? by_crossings(model, point, max_nodes, pages, work, reason)
             : by_winding_number(model.tree(), point, max_nodes, pages, work, reason);
}

std::optional<Standing> side_at_once(const ModelState& model, const Point& point,
                                     const octree::ColourMap::Spot& spot) noexcept {
  if (spot.winding != octree::ColourMap::kUnknown)
    return Standing{spot.winding != 0 ? Side::kInside : Side::kOutside, Status::kExact,
                    spot.winding};
  if (is_untold(model, point)) return Standing{};
  if (model.info().watertight() && outside_box(model.tree(), point))
    return Standing{Side::kOutside};
  return {};
}

bool is_side_as_before(const ModelState& model, const Point& point, double clear,
                       SideMemory& memory) noexcept {
  if (!model.region().holds(point) || !memory.same_side(point, clear)) return false;
  memory.go_to(point, clear);
  return true;
}

Standing find_side(const ModelState& model, const Point& point, const octree::ColourMap::Spot& spot,
                   double clear, SideMemory& memory, std::uint64_t max_nodes,
                   const octree::PageReader& pages, octree::TreeWork& work) noexcept {
  if (!model.info().watertight() || !model.region().holds(point) ||
      outside_box(model.tree(), point))
    return find_side(model, point, max_nodes, pages, work);
  if (is_side_as_before(model, point, clear, memory)) return memory.standing();
  SideSearch search(model, point, max_nodes, pages, work, nullptr, {&memory, &spot});
  const Standing standing = search.run();
  if (standing.status == Status::kExact) memory.note(point, standing, search.counted(), clear);
  return standing;
}

}  // namespace planetree::query
