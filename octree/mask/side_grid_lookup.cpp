#include "octree/mask/side_grid.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "octree/mask/side_grid_lookup.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "octree/geometry/wide_floats-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {

#if PLANETREE_EIGHT_LANES

using WordTag = hn::FixedTag<std::uint64_t, 4>;
using StepTag = hn::RebindToSigned<WordTag>;
using Words = hn::Vec<WordTag>;
using Steps = hn::Vec<StepTag>;

HWY_INLINE Words bits_of(double x, double y, double z) {
  const hn::FixedTag<double, 2> pair;
  const hn::FixedTag<double, 4> all;
  const auto xy = hn::InterleaveLower(pair, hn::Set(pair, x), hn::Set(pair, y));
  return hn::BitCast(WordTag(), hn::Combine(all, hn::Set(pair, z), xy));
}

// Returns the sum over the axes of value times factor, both below 2^32.
HWY_INLINE std::size_t weighted_sum(Words values, Words factors) {
  const hn::Repartition<std::uint32_t, WordTag> halves;
  const auto products = hn::MulEven(hn::BitCast(halves, values), hn::BitCast(halves, factors));
  return hn::GetLane(hn::SumOfLanes(WordTag(), products));
}

// Returns one bit of each axis: an octant.
template <int kShift>
HWY_INLINE unsigned bits_at(Steps coordinates) {
  const StepTag signs;
  return mask_bits(signs, hn::Lt(hn::ShiftLeft<63 - kShift>(coordinates), hn::Zero(signs))) & 7;
}

// `noipa` hides this function's body from its caller. When gcc 12 sees that a function uses no
// vectors, the caller leaves the upper halves of its vectors in use, across the call and on return.
// The code that runs next then waits for them.
[[gnu::noipa]] int winding_below(const SideGridCells& cells, SideGridCells::Cell cell,
                                 unsigned octant, unsigned part) {
  return cells.find_below(cell, octant, part).winding;
}

// Does what GridCoordinates::find() and FixedPoint::digits_of() do, with one axis in each lane. The
// fourth lane is uncertain only if another one is.
int find_fast_on_target(const GridCoordinates& coordinates, const SideGridCells& cells, double x,
                        double y, double z) {
  const WordTag words;
  const StepTag signs;
  const Words bits = bits_of(x, y, z);
  const Words exponent = hn::And(hn::ShiftRight<52>(bits), hn::Set(words, 0x7ff));
  const Words highest = hn::Set(words, std::uint64_t{1} << 63);
  const Words digits = hn::ShiftRight<2>(hn::Or(hn::ShiftLeft<11>(bits), highest));
  const Steps shift =
      hn::Sub(hn::Set(signs, coordinates.input.shift()), hn::BitCast(signs, exponent));
  const Words shown = digits >> hn::BitCast(words, hn::Min(shift, hn::Set(signs, 63)));
  const Steps sign = hn::BroadcastSignBit(hn::BitCast(signs, bits));
  const Steps from_zero = hn::Sub(hn::Xor(hn::BitCast(signs, shown), sign), sign);
  const Steps beyond = hn::Sub(from_zero, hn::Load(signs, coordinates.first.data()));
  const Steps step = hn::Min(hn::Max(beyond, hn::Set(signs, GridCoordinates::kRimMiddle)),
                             hn::Load(signs, coordinates.last_middle.data()));
  const Steps past_side = hn::And(step, hn::Set(signs, GridCoordinates::kMin - 1));
  const auto uncertainty = hn::Or(hn::Lt(shift, hn::Zero(signs)),
                                  hn::Lt(past_side, hn::Set(signs, coordinates.uncertainty)));
  if (!hn::AllFalse(signs, uncertainty)) return SideGridCells::kUnknown;
  constexpr int kBrickShift = FixedPoint::kBits + int{SideGridCells::kBrickBits};
  const SideGridCells::Cell cell{
      weighted_sum(hn::ShiftRight<kBrickShift>(hn::BitCast(words, step)),
                   hn::Load(words, coordinates.stride.data())),
      bits_at<FixedPoint::kBits + 1>(step) << 3 | bits_at<FixedPoint::kBits>(step)};
  // Points that this lookup answers are seldom in the brick of the one before, so that none of the
  // brick's lines is likely to be in the cache.
  const unsigned code = cells.code_of<3>(cell);
  if (code != SideGridCells::kListed) return cells.find_by_code(code).winding;
  return winding_below(cells, cell, bits_at<GridCoordinates::kOctantBits>(step),
                       bits_at<GridCoordinates::kMinBits>(step));
}

#else

int find_fast_on_target(const GridCoordinates& coordinates, const SideGridCells& cells, double x,
                        double y, double z) {
  const std::array<double, 3> point{x, y, z};
  GridCoordinates::Position position;
  if (!coordinates.find(point.data(), coordinates.input, position)) return SideGridCells::kUnknown;
  return find(coordinates, cells, position).winding;
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planetree::octree {

HWY_EXPORT(find_fast_on_target);

SideGridLookup fastest_side_grid_lookup() noexcept {
  // Without this, the pointer might be to Highway's function that chooses a target.
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  return &HWY_DYNAMIC_DISPATCH(find_fast_on_target);
}

}  // namespace planetree::octree
#endif
