#include "octree/child_tests.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "octree/child_tests.cpp"
#include <hwy/foreach_target.h>

#include "octree/node_kernels-inl.h"
#include "octree/strict_math.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {

unsigned meeting_on_target(const Node& node, const FloatBox& box) {
  const FloatTag lanes;
  unsigned found = 0;
  for (std::size_t first = 0; first < kFanOut; first += hn::Lanes(lanes)) {
    auto apart = hn::FirstN(lanes, 0);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto lower = hn::Load(lanes, node.lower[axis] + first);
      const auto upper = hn::Load(lanes, node.upper[axis] + first);
      apart = hn::Or(apart, hn::Gt(lower, hn::Set(lanes, box.upper[axis])));
      apart = hn::Or(apart, hn::Lt(upper, hn::Set(lanes, box.lower[axis])));
    }
    found |= mask_bits(lanes, hn::Not(apart)) << first;
  }
  return found & ((1U << node.child_count) - 1);
}

unsigned within_on_target(const Node& node, const FloatQuery& query, float threshold) {
  const FloatTag d;
  const Wide3 p{hn::Set(d, query.x), hn::Set(d, query.y), hn::Set(d, query.z)};
  unsigned found = 0;
  for (std::size_t i = 0; i < kFanOut; i += hn::Lanes(d))
    found |= bits_not_above(child_bounds(node, p, false, i), threshold) << i;
  return found & ((1U << node.child_count) - 1);
}

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planetree::octree {

HWY_EXPORT(meeting_on_target);
HWY_EXPORT(within_on_target);

unsigned children_meeting(const Node& node, const FloatBox& box) noexcept {
  return HWY_DYNAMIC_DISPATCH(meeting_on_target)(node, box);
}

unsigned children_within(const Node& node, const FloatQuery& query, float threshold) noexcept {
  return HWY_DYNAMIC_DISPATCH(within_on_target)(node, query, threshold);
}

}  // namespace planetree::octree
#endif
