#include "query/answer/sheet_side.h"

#include "octree/geometry/predicates.h"
#include "octree/geometry/strict_math.h"
#include "octree/geometry/work_limit.h"

namespace planetree::query {
namespace {

using octree::Front;

// Share of the upper bound of a distance that the lower bound exceeds if the query is certainly off
// the surface and its nearest feature is that of the answer.
constexpr double kCertainShare = 0.5;
// A query that lies on a triangle of the core has a smaller computed distance: values err by less
// than 2^-42 of the distance of the farthest corner.
constexpr double kCertainDistance = 0x1p-36;

}  // namespace

bool is_proven(const octree::TreeInfo& tree, const octree::NearestAnswer& nearest) noexcept {
  return nearest.status == Status::kExact && nearest.triangle != kNoTriangle &&
         nearest.upper - nearest.lower < tree.span(tree.centre);
}

std::optional<Front> front_at_surface(const octree::TreeInfo& tree, const octree::Point& query,
                                      const octree::NearestAnswer& nearest, std::uint64_t max_work,
                                      const octree::PageReader& pages,
                                      octree::TraversalStats& work) noexcept {
  octree::WorkLimit limit(work.units, max_work);
  if (nearest.distance < kCertainDistance && octree::lies_on(query, nearest.corners, &limit) &&
      !limit.exceeded())
    return Front::kOnSurface;
  if (!is_proven(tree, nearest) || nearest.lower > kCertainShare * nearest.upper) return {};
  return octree::front_of_all_within(tree, query, nearest.upper, limit.left(), pages, work);
}

SideResult side_of(Front front) noexcept {
  switch (front) {
    case Front::kInFront:
    case Front::kLevel:
      return {Side::kOutside};
    case Front::kBehind:
      return {Side::kInside};
    case Front::kOnSurface:
      return {Side::kOnSurface};
    case Front::kUnknown:
      break;
  }
  return {Side::kUnknown, Status::kDegraded};
}

}  // namespace planetree::query
