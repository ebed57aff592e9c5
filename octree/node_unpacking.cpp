#include "octree/node_unpacking.h"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "octree/node_unpacking.cpp"
#include <hwy/foreach_target.h>

#include "octree/strict_math.h"
#include "octree/wide_floats-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {

template <class T>
HWY_INLINE Ints widened(const std::uint8_t* bytes) {
  const hn::Rebind<T, IntTag> narrow;
  return hn::PromoteTo(IntTag(), hn::LoadU(narrow, reinterpret_cast<const T*>(bytes)));
}

// Words whose high bytes are of type High.
template <class High>
HWY_INLINE Ints widened(const PackedChildren::Words& words, unsigned first) {
  return hn::Or(hn::ShiftLeft<8>(widened<High>(words.high.data() + first)),
                widened<std::uint8_t>(words.low.data() + first));
}

// std::min() and std::max() to the last bit: of equal values the first.
HWY_INLINE Floats at_most(Floats value, Floats most) {
  return hn::IfThenElse(hn::Lt(most, value), most, value);
}
HWY_INLINE Floats at_least(Floats value, Floats least) {
  return hn::IfThenElse(hn::Lt(value, least), least, value);
}

// unpack_normal()
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

// Children from `first` on, as many as a register has lanes.
class ChildLanes {
 public:
  ChildLanes(const PackedChildren& packed, unsigned count, unsigned first)
      : packed_(packed),
        first_(first),
        used_(hn::FirstN(lanes_, count > first ? count - first : 0)) {}

  // unpack_box()
  void store_boxes(const FloatBox& box, Node& node) {
    const float infinity = std::numeric_limits<float>::infinity();
    Floats squares[3];
    for (unsigned axis = 0; axis < 3; ++axis) {
      const Ints low = widened<std::uint8_t>(packed_.box[axis].data() + first_);
      const Ints high = widened<std::uint8_t>(packed_.box[3 + axis].data() + first_);
      const Floats lower = hn::Set(lanes_, box.lower[axis]);
      const Floats upper = hn::Set(lanes_, box.upper[axis]);
      const Floats step = hn::Mul(hn::Sub(upper, lower), hn::Set(lanes_, 1.0f / 255.0f));
      const auto coordinate = [&](Ints steps) {
        return at_most(hn::Add(lower, hn::Mul(hn::ConvertTo(lanes_, steps), step)), upper);
      };
      const auto whole = hn::RebindMask(lanes_, hn::Eq(high, hn::Set(IntTag(), 255)));
      const Floats from = coordinate(low), to = hn::IfThenElse(whole, upper, coordinate(high));
      const Floats length = hn::Sub(to, from);
      squares[axis] = hn::Mul(length, length);
      store(from, infinity, node.lower[axis]);
      store(to, infinity, node.upper[axis]);
      faults_.no_box |= any_above(low, high);
    }
    const Floats square = hn::Add(hn::Add(squares[0], squares[1]), squares[2]);
    plane_step_ = hn::Mul(hn::Sqrt(square), hn::Set(lanes_, 1.0f / 32000.0f));
  }

  // unpack_disc(); after the boxes
  void store_discs(Node& node) {
    const Wide3 normal =
        unpack_normals(words<std::int8_t>(packed_.u), words<std::int8_t>(packed_.v));
    store(normal.x, 0, node.normal[0]);
    store(normal.y, 0, node.normal[1]);
    store(normal.z, 1, node.normal[2]);
    const Ints lower = words<std::int8_t>(packed_.slab_lower);
    const Ints upper = words<std::int8_t>(packed_.slab_upper);
    store(scaled(lower), 0, node.slab_lower);
    store(scaled(upper), 0, node.slab_upper);
    store(scaled(words<std::uint8_t>(packed_.radius)), 0, node.radius);
    faults_.crossed |= any_above(lower, upper);
  }

  const ChildFaults& faults() const { return faults_; }

 private:
  template <class High>
  Ints words(const PackedChildren::Words& of_all) const {
    return widened<High>(of_all, first_);
  }
  Floats scaled(Ints steps) const { return hn::Mul(hn::ConvertTo(lanes_, steps), plane_step_); }
  void store(Floats values, float absent, float (&field)[kFanOut]) const {
    hn::StoreU(hn::IfThenElse(used_, values, hn::Set(lanes_, absent)), lanes_, field + first_);
  }
  // Absent children have 0 for both.
  static bool any_above(Ints lower, Ints upper) {
    return !hn::AllFalse(IntTag(), hn::Gt(lower, upper));
  }

  const FloatTag lanes_{};
  const PackedChildren& packed_;
  const unsigned first_;
  const hn::Mask<FloatTag> used_;
  Floats plane_step_{};
  ChildFaults faults_;
};

ChildFaults children_on_target(const PackedChildren& packed, unsigned count, const FloatBox& box,
                               Node& node) {
  ChildFaults faults;
  for (unsigned first = 0; first < kFanOut; first += static_cast<unsigned>(hn::Lanes(FloatTag()))) {
    ChildLanes lanes(packed, count, first);
    lanes.store_boxes(box, node);
    lanes.store_discs(node);
    faults.no_box |= lanes.faults().no_box;
    faults.crossed |= lanes.faults().crossed;
  }
  return faults;
}

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planetree::octree {

HWY_EXPORT(children_on_target);

ChildFaults unpack_children(const PackedChildren& packed, unsigned count, const FloatBox& box,
                            Node& node) noexcept {
  return HWY_DYNAMIC_DISPATCH(children_on_target)(packed, count, box, node);
}

}  // namespace planetree::octree
#endif
