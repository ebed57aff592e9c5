#include "octree/outcodes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "octree/outcodes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <cmath>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Of vertices that float holds exactly, whole vectors of them.
void float_codes(const float* HWY_RESTRICT vertices, unsigned stride, const float (&lower)[3],
                 const float (&upper)[3], std::uint8_t* HWY_RESTRICT codes) {
  const hn::CappedTag<float, 8> d;
  const hn::RebindToSigned<decltype(d)> di;
  const hn::Rebind<std::uint8_t, decltype(d)> bytes;
  for (std::size_t i = 0; i < stride; i += hn::Lanes(d)) {
    auto code = hn::Zero(di);
    for (unsigned axis = 0; axis < 3; ++axis) {
      const auto at = hn::Load(d, vertices + axis * stride + i);
      const auto below = hn::RebindMask(di, hn::Lt(at, hn::Set(d, lower[axis])));
      const auto above = hn::RebindMask(di, hn::Gt(at, hn::Set(d, upper[axis])));
      code = hn::Or(code, hn::IfThenElseZero(below, hn::Set(di, 1 << (2 * axis))));
      code = hn::Or(code, hn::IfThenElseZero(above, hn::Set(di, 2 << (2 * axis))));
    }
    hn::StoreU(hn::DemoteTo(bytes, code), bytes, codes + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planetree::octree {
namespace {

HWY_EXPORT(float_codes);

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// A float that is not beyond the value, and none but its neighbour is nearer.
float not_above(double value) {
  const auto rounded = static_cast<float>(value);
  return rounded > value ? std::nextafter(rounded, -kInfinity) : rounded;
}
float not_below(double value) {
  const auto rounded = static_cast<float>(value);
  return rounded < value ? std::nextafter(rounded, kInfinity) : rounded;
}

}  // namespace

Outcodes::Outcodes(const BlockView& block, const Point& lower, const Point& upper) noexcept
    : corner_(block.header().corner) {
  if (const float* vertices = block.float_vertices()) {
    const float low[3] = {not_above(lower.x()), not_above(lower.y()), not_above(lower.z())};
    const float high[3] = {not_below(upper.x()), not_below(upper.y()), not_below(upper.z())};
    HWY_DYNAMIC_DISPATCH(float_codes)(vertices, block.header().stride, low, high, code_.data());
    return;
  }
  for (unsigned i = 0; i < block.header().vertex_count; ++i) {
    const Point vertex = block.vertex(i);
    unsigned code = 0;
    for (unsigned axis = 0; axis < 3; ++axis)
      code |= static_cast<unsigned>(vertex[axis] < lower[axis]) << (2 * axis) |
              static_cast<unsigned>(vertex[axis] > upper[axis]) << (2 * axis + 1);
    code_[i] = static_cast<std::uint8_t>(code);
  }
}

}  // namespace planetree::octree
#endif
