// Sides of the boxes of a node's children, with the same bits as child_box().

#if defined(PLANETREE_OCTREE_CHILD_SIDES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANETREE_OCTREE_CHILD_SIDES_INL_H_
#undef PLANETREE_OCTREE_CHILD_SIDES_INL_H_
#else
#define PLANETREE_OCTREE_CHILD_SIDES_INL_H_
#endif

#include <cstddef>
#include <cstdint>

#include "octree/geometry/wide_floats-inl.h"
#include "octree/page/frame.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Loads and widens as many bytes as a register has lanes.
HWY_INLINE Ints widened_bytes(const std::uint8_t* bytes) {
  const hn::Rebind<std::uint8_t, IntTag> narrow;
  return hn::PromoteTo(IntTag(), hn::LoadU(narrow, bytes));
}

// Returns the sides along one axis of the children from `i` on.
HWY_INLINE Floats lower_sides(const Node& node, std::size_t axis, std::size_t i) {
  const FloatTag d;
  const Floats steps = hn::ConvertTo(d, widened_bytes(node.lower[axis] + i));
  return hn::Add(hn::Set(d, node.box.lower[axis]), hn::Mul(steps, hn::Set(d, node.step[axis])));
}
HWY_INLINE Floats upper_sides(const Node& node, std::size_t axis, std::size_t i) {
  const FloatTag d;
  const Floats steps = hn::ConvertTo(d, widened_bytes(node.upper[axis] + i));
  return hn::Sub(hn::Set(d, node.box.upper[axis]), hn::Mul(steps, hn::Set(d, node.step[axis])));
}

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#endif
