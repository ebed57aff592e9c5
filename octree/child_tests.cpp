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
  return meeting_children(node, box);
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
