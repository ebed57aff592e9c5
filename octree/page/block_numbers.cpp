#include "octree/page/block_unpacking.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "octree/page/block_numbers.cpp"
#include <hwy/foreach_target.h>

#include "octree/page/split_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {

bool indices_one_by_one(const ByteSplit<std::uint16_t>& refs, const BlockVertices& block,
                        unsigned stride, std::uint16_t* indices) {
  std::size_t index = 0;
  bool good = true;
  for (unsigned i = 0; i < block.ref_count; ++i) {
    const std::uint16_t step = refs[block.first_ref + i];
    good &= i == 0 || step > 0;
    index += step;
    indices[i] = static_cast<std::uint16_t>(index);
  }
  good &= block.ref_count == 0 || index < block.first_new;
  for (unsigned i = block.ref_count; i < block.vertex_count; ++i)
    indices[i] = static_cast<std::uint16_t>(block.first_new + (i - block.ref_count));
  std::fill(indices + block.vertex_count, indices + stride, indices[0]);
  return good;
}

template <class Id>
bool ids_one_by_one(Id first, const ByteSplit<Id>& steps, std::size_t first_step, unsigned count,
                    Id* ids) {
  Id id = ids[0] = first;
  bool ascend = true;
  for (unsigned i = 1; i < count; ++i) {
    const Id last = id;
    id = static_cast<Id>(id + steps[first_step + i - 1]);
    ascend &= id > last;  // false also for a sum that overflows
    ids[i] = id;
  }
  std::fill(ids + count, ids + kMaxBlockTriangles, id);
  return ascend;
}

#if HWY_TARGET != HWY_SCALAR

// Returns how many of the lanes from `first` on are among the first `count`.
HWY_INLINE std::size_t lanes_left(std::size_t count, std::size_t first) {
  return count > first ? count - first : 0;
}

// Returns how many sums are above the one before, sum - step. A sum that wraps around is not.
template <class Lanes>
HWY_INLINE std::size_t count_rising(Lanes sums, Lanes steps) {
  return hn::CountTrue(hn::DFromV<Lanes>(), hn::Gt(sums, hn::Sub(sums, steps)));
}

// Requires `stride` refs from block.first_ref on.
bool indices_by_lanes(const ByteSplit<std::uint16_t>& refs, const BlockVertices& block,
                      unsigned stride, std::uint16_t* indices) {
  const PairTag pairs;
  const auto wide = [&](std::size_t number) {
    return hn::Set(pairs, static_cast<std::uint16_t>(number));
  };
  Pairs last = hn::Zero(pairs), first = last;
  std::size_t rising = 0;
  for (unsigned i = 0; i < stride; i += 8) {
    const auto referred = hn::FirstN(pairs, lanes_left(block.ref_count, i));
    const Pairs steps =
        hn::IfThenElseZero(referred, load_eight(refs.bytes(), refs.size(), block.first_ref + i));
    Pairs sums = hn::Add(steps, hn::ShiftLeftLanes<1>(pairs, steps));
    sums = hn::Add(sums, hn::ShiftLeftLanes<2>(pairs, sums));
    sums = hn::Add(hn::Add(sums, hn::ShiftLeftLanes<4>(pairs, sums)), last);
    last = hn::Broadcast<7>(sums);
    rising += count_rising(sums, steps);
    const Pairs others = hn::Add(hn::Iota(pairs, static_cast<std::uint16_t>(i)),
                                 wide(block.first_new - block.ref_count));
    const Pairs all = hn::IfThenElse(referred, sums, others);
    if (i == 0) {
      first = hn::Broadcast<0>(all);
      // The first step is a starting value, not a difference.
      rising -= block.ref_count > 0 && hn::GetLane(steps) > 0 ? 1 : 0;
    }
    const auto known = hn::FirstN(pairs, lanes_left(block.vertex_count, i));
    hn::StoreU(hn::IfThenElse(known, all, first), pairs, indices + i);
  }
  return block.ref_count == 0 ||
         (rising == block.ref_count - 1 && indices[block.ref_count - 1] < block.first_new);
}

// Requires a step before `first_step` and kMaxBlockTriangles - 1 steps from it on.
bool ids_by_lanes(std::uint32_t first, const ByteSplit<std::uint32_t>& steps,
                  std::size_t first_step, unsigned count, std::uint32_t* ids) {
  const ByteTag bytes;
  const QuadTag quads;
  Bytes planes[4];
  load_sixteen(steps.bytes(), steps.size(), first_step - 1, planes);
  const auto others = hn::And(hn::FirstN(bytes, count), hn::Not(hn::FirstN(bytes, 1)));
  for (Bytes& plane : planes) plane = hn::IfThenElseZero(others, plane);
  Quads step[4];
  join_planes(planes, step);
  Quads last = hn::Set(quads, first);
  std::size_t rising = 0;
  for (unsigned i = 0; i < 4; ++i) {
    Quads sums = hn::Add(step[i], hn::ShiftLeftLanes<1>(quads, step[i]));
    sums = hn::Add(hn::Add(sums, hn::ShiftLeftLanes<2>(quads, sums)), last);
    last = hn::Broadcast<3>(sums);
    rising += count_rising(sums, step[i]);
    hn::StoreU(sums, quads, ids + 4 * i);
  }
  return rising == count - 1;
}

#endif

// Vector code reads whole registers and therefore needs an array that contains them.
bool indices_on_target(const ByteSplit<std::uint16_t>& refs, const BlockVertices& block,
                       unsigned stride, std::uint16_t* indices) {
#if HWY_TARGET != HWY_SCALAR
  if (block.first_ref + stride <= refs.size())
    return indices_by_lanes(refs, block, stride, indices);
#endif
  return indices_one_by_one(refs, block, stride, indices);
}

bool ids_on_target(std::uint32_t first, const ByteSplit<std::uint32_t>& steps,
                   std::size_t first_step, unsigned count, std::uint32_t* ids) {
#if HWY_TARGET != HWY_SCALAR
  if (first_step > 0 && first_step - 1 + kMaxBlockTriangles <= steps.size())
    return ids_by_lanes(first, steps, first_step, count, ids);
#endif
  return ids_one_by_one(first, steps, first_step, count, ids);
}

bool wide_ids_on_target(std::uint64_t first, const ByteSplit<std::uint64_t>& steps,
                        std::size_t first_step, unsigned count, std::uint64_t* ids) {
  return ids_one_by_one(first, steps, first_step, count, ids);
}

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planetree::octree {

HWY_EXPORT(indices_on_target);
HWY_EXPORT(ids_on_target);
HWY_EXPORT(wide_ids_on_target);

bool unpack_indices(const ByteSplit<std::uint16_t>& refs, const BlockVertices& block,
                    unsigned stride, std::uint16_t* indices) noexcept {
  return HWY_DYNAMIC_DISPATCH(indices_on_target)(refs, block, stride, indices);
}

bool unpack_ids(std::uint32_t first, const ByteSplit<std::uint32_t>& steps, std::size_t first_step,
                unsigned count, std::uint32_t* ids) noexcept {
  return HWY_DYNAMIC_DISPATCH(ids_on_target)(first, steps, first_step, count, ids);
}

bool unpack_ids(std::uint64_t first, const ByteSplit<std::uint64_t>& steps, std::size_t first_step,
                unsigned count, std::uint64_t* ids) noexcept {
  return HWY_DYNAMIC_DISPATCH(wide_ids_on_target)(first, steps, first_step, count, ids);
}

}  // namespace planetree::octree
#endif
