#include "octree/traversal/triangle_overlap.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "octree/traversal/triangle_overlap.cpp"
#include <hwy/foreach_target.h>

#include <algorithm>
#include <bit>

#include "octree/geometry/strict_math.h"
#include "octree/traversal/bounds.h"
#include "octree/traversal/triangle_filter-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {

unsigned triangles_on_target(const BlockView& block, const Point& point, float limit,
                             double (&nearest)[kMaxBlockTriangles]) {
  const BlockHeader& header = block.header();
  FilteredTriangles filtered;
  filter_block(header, FloatOffset(point, block.vertex(0)).at, limit, filtered);
  for (unsigned near = filtered.near; near != 0; near &= near - 1) {
    const auto i = static_cast<unsigned>(std::countr_zero(near));
    nearest[i] = filter_lower(filtered.squared[i], header.extent);
  }
  return filtered.near;
}

NearbyTriangleBits corners_on_target(const NearbyTriangles& list, float x) {
  const TriangleTag d;
  const auto at = hn::Set(d, x);
  NearbyTriangleBits found{};
  for (std::size_t i = 0; i < list.size(); i += hn::Lanes(d)) {
    auto same = hn::Eq(hn::Load(d, list.row(0, 0) + i), at);
    for (std::size_t corner = 1; corner < 3; ++corner)
      same = hn::Or(same, hn::Eq(hn::Load(d, list.row(corner, 0) + i), at));
    std::uint64_t bits = mask_bits(d, same);
    if (list.size() - i < hn::Lanes(d)) bits &= (std::uint64_t{1} << (list.size() - i)) - 1;
    found[i / 64] |= bits << i % 64;
  }
  return found;
}

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planetree::octree {

HWY_EXPORT(triangles_on_target);
HWY_EXPORT(corners_on_target);

unsigned triangles_within(const BlockView& block, const Point& point, const FloatQuery& wide,
                          double distance, double (&nearest)[kMaxBlockTriangles]) noexcept {
  // The block is too small for float, or the query too far away.
  if (!can_filter(wide, block.header().extent)) {
    std::fill_n(nearest, block.triangle_count(), 0.0);
    return (1U << block.triangle_count()) - 1;
  }
  const float limit = filter_threshold(wide, distance, block.header().extent);
  return HWY_DYNAMIC_DISPATCH(triangles_on_target)(block, point, limit, nearest);
}

NearbyTriangleBits triangles_with_corner(const NearbyTriangles& list,
                                         const Point& corner) noexcept {
  // Rounded as in the list.
  const auto x = static_cast<float>(corner.x() - list.centre().x());
  return HWY_DYNAMIC_DISPATCH(corners_on_target)(list, x);
}

}  // namespace planetree::octree
#endif
