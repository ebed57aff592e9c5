#include "octree/page/node_unpacking.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "octree/page/node_unpacking.cpp"
#include <hwy/foreach_target.h>

#include "octree/geometry/strict_math.h"
#include "octree/page/frame_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {

// Joins the bytes of words; High is the type of the high byte.
template <class High>
HWY_INLINE Ints widened(const PackedDiscs::Words& words, unsigned first) {
  const hn::Rebind<High, IntTag> narrow;
  const auto* high = reinterpret_cast<const High*>(words.high.data() + first);
  return hn::Or(hn::ShiftLeft<8>(hn::PromoteTo(IntTag(), hn::LoadU(narrow, high))),
                widened_bytes(words.low.data() + first));
}

// Returns std::max(value, least) to the last bit: the first of equal values.
HWY_INLINE Floats at_least(Floats value, Floats least) {
  return hn::IfThenElse(hn::Lt(value, least), least, value);
}

// Same as unpack_normal().
HWY_INLINE Wide3 unpack_normals(Ints u, Ints v) {
  const FloatTag lanes;
  const Floats steps = hn::Set(lanes, kNormalSteps), one = hn::Set(lanes, 1.0f);
  const Floats least = hn::Set(lanes, -1.0f), zero = hn::Zero(lanes);
  const Floats x = at_least(hn::Div(hn::ConvertTo(lanes, u), steps), least);
  const Floats y = at_least(hn::Div(hn::ConvertTo(lanes, v), steps), least);
  const Floats z = hn::Sub(hn::Sub(one, hn::Abs(x)), hn::Abs(y));
  const auto folded = [&](Floats along, Floats across) {
    const Floats fold = hn::Sub(one, hn::Abs(across));
    const Floats signed_fold = hn::IfThenElse(hn::Lt(along, zero), hn::Neg(fold), fold);
    return hn::IfThenElse(hn::Lt(z, zero), signed_fold, along);
  };
  const Wide3 normal{folded(x, y), folded(y, x), z};
  const Floats length = hn::Sqrt(dot(normal, normal));
  return {hn::Div(normal.x, length), hn::Div(normal.y, length), hn::Div(normal.z, length)};
}

// Discs of the children from `first` on, as many as a register has lanes.
class DiscLanes {
 public:
  DiscLanes(const PackedDiscs& packed, unsigned count, unsigned first)
      : packed_(packed),
        first_(first),
        used_(hn::FirstN(lanes_, count > first ? count - first : 0)) {}

  ChildFaults store(Node& node) const {
    const Floats unit = plane_steps(node);
    const Wide3 normal =
        unpack_normals(words<std::int8_t>(packed_.u), words<std::int8_t>(packed_.v));
    store(normal.x, 0, node.normal[0]);
    store(normal.y, 0, node.normal[1]);
    store(normal.z, 1, node.normal[2]);
    const Ints lower = words<std::int8_t>(packed_.slab_lower);
    const Ints upper = words<std::int8_t>(packed_.slab_upper);
    const auto scaled = [&](Ints steps) { return hn::Mul(hn::ConvertTo(lanes_, steps), unit); };
    store(scaled(lower), 0, node.slab_lower);
    store(scaled(upper), 0, node.slab_upper);
    store(scaled(words<std::uint8_t>(packed_.radius)), 0, node.radius);
    return {any_without_box(node), any_above(lower, upper)};
  }

 private:
  // Same as FloatBox::plane_step().
  Floats plane_steps(const Node& node) const {
    Floats squares[3];
    for (unsigned axis = 0; axis < 3; ++axis) {
      const Floats length =
          hn::Sub(upper_sides(node, axis, first_), lower_sides(node, axis, first_));
      squares[axis] = hn::Mul(length, length);
    }
    const Floats square = hn::Add(hn::Add(squares[0], squares[1]), squares[2]);
    return hn::Mul(hn::Sqrt(square), hn::Set(lanes_, 1.0f / 32000.0f));
  }
  bool any_without_box(const Node& node) const {
    Ints max_steps = hn::Zero(IntTag());
    for (unsigned axis = 0; axis < 3; ++axis)
      max_steps = hn::Max(max_steps, hn::Add(widened_bytes(node.lower[axis] + first_),
                                             widened_bytes(node.upper[axis] + first_)));
    return any_above(max_steps, hn::Set(IntTag(), kBoxSteps));
  }
  template <class High>
  Ints words(const PackedDiscs::Words& of_all) const {
    return widened<High>(of_all, first_);
  }
  void store(Floats values, float absent, float (&field)[kFanOut]) const {
    hn::StoreU(hn::IfThenElse(used_, values, hn::Set(lanes_, absent)), lanes_, field + first_);
  }
  // Absent children have 0 for both.
  static bool any_above(Ints lower, Ints upper) {
    return !hn::AllFalse(IntTag(), hn::Gt(lower, upper));
  }

  const FloatTag lanes_{};
  const PackedDiscs& packed_;
  const unsigned first_;
  const hn::Mask<FloatTag> used_;
};

ChildFaults discs_on_target(const PackedDiscs& packed, unsigned count, Node& node) {
  ChildFaults faults;
  for (unsigned first = 0; first < kFanOut; first += static_cast<unsigned>(hn::Lanes(FloatTag()))) {
    const ChildFaults found = DiscLanes(packed, count, first).store(node);
    faults.inverted_box |= found.inverted_box;
    faults.inverted_slab |= found.inverted_slab;
  }
  return faults;
}

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planetree::octree {

HWY_EXPORT(discs_on_target);

ChildFaults unpack_discs(const PackedDiscs& packed, unsigned count, Node& node) noexcept {
  return HWY_DYNAMIC_DISPATCH(discs_on_target)(packed, count, node);
}

}  // namespace planetree::octree
#endif
