#include "octree/box_walk.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "octree/box_walk.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "octree/strict_math.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

unsigned meeting_on_target(const Node& node, const FloatBox& box) {
  const hn::CappedTag<float, kFanOut> lanes;
  unsigned found = 0;
  for (std::size_t first = 0; first < kFanOut; first += hn::Lanes(lanes)) {
    auto apart = hn::FirstN(lanes, 0);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto lower = hn::Load(lanes, node.lower[axis] + first);
      const auto upper = hn::Load(lanes, node.upper[axis] + first);
      apart = hn::Or(apart, hn::Gt(lower, hn::Set(lanes, box.upper[axis])));
      apart = hn::Or(apart, hn::Lt(upper, hn::Set(lanes, box.lower[axis])));
    }
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(lanes, apart, bits);
    found |= (~unsigned{bits[0]} & ((1U << hn::Lanes(lanes)) - 1)) << first;
  }
  return found & ((1U << node.child_count) - 1);
}

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planetree::octree {

HWY_EXPORT(meeting_on_target);

unsigned children_meeting(const Node& node, const FloatBox& box) noexcept {
  return HWY_DYNAMIC_DISPATCH(meeting_on_target)(node, box);
}

}  // namespace planetree::octree
#endif
