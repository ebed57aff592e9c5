#include "octree/traversal/overlap.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "octree/traversal/overlap.cpp"
#include <hwy/foreach_target.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

#include "octree/geometry/strict_math.h"
#include "octree/geometry/wide_floats-inl.h"
#include "octree/page/frame_lanes-inl.h"
#include "octree/traversal/bounds.h"
#include "octree/traversal/node_kernels-inl.h"
#include "octree/traversal/triangle_filter-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {

unsigned meeting_on_target(const Node& node, const FloatBox& box) {
  return meeting_children(node, box);
}

std::uint64_t subtrees_on_target(const NearbySubtrees& list, const FloatBox& box) {
  const TriangleTag d;
  std::uint64_t found = 0;
  for (std::size_t i = 0; i < list.size(); i += hn::Lanes(d)) {
    auto apart = hn::FirstN(d, 0);
#pragma GCC unroll 3
    for (std::size_t axis = 0; axis < 3; ++axis) {
      apart = hn::Or(apart, hn::Gt(hn::Load(d, list.lower(axis) + i), hn::Set(d, box.upper[axis])));
      apart = hn::Or(apart, hn::Lt(hn::Load(d, list.upper(axis) + i), hn::Set(d, box.lower[axis])));
    }
    found |= std::uint64_t{mask_bits(d, hn::Not(apart))} << i;
  }
  return list.size() < NearbySubtrees::kMax ? found & ((std::uint64_t{1} << list.size()) - 1)
                                            : found;
}

void add_within_on_target(const Node& node, const FloatQuery& query, float threshold,
                          NearbySubtrees& list) {
  const FloatTag d;
  const hn::RebindToUnsigned<FloatTag> du;
  const Wide3 p{hn::Set(d, query.x), hn::Set(d, query.y), hn::Set(d, query.z)};
  for (std::size_t i = 0; i < node.child_count; i += hn::Lanes(d)) {
    const auto beyond = hn::Gt(child_bounds(node, p, false, i), hn::Set(d, threshold));
    const PackedLanes near(d, hn::AndNot(beyond, hn::FirstN(d, node.child_count - i)));
#pragma GCC unroll 3
    for (std::size_t axis = 0; axis < 3; ++axis) {
      near.store(lower_sides(node, axis, i), list.next_lower(axis));
      near.store(upper_sides(node, axis, i), list.next_upper(axis));
    }
    near.store(hn::Load(du, node.link + i), list.next_link());
    list.add(near.count());
  }
}

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

// Writes the outcodes of vertices that are exact in float, whole vectors of them.
void float_codes(const float* HWY_RESTRICT vertices, unsigned stride, const float (&lower)[3],
                 const float (&upper)[3], std::uint8_t* HWY_RESTRICT codes) {
  const FloatTag d;
  const IntTag di;
  const hn::Rebind<std::uint8_t, FloatTag> bytes;
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

CornerCodes float_corner_codes(const BlockHeader& block, const float* vertices,
                               const float (&lower)[3], const float (&upper)[3]) {
  HWY_ALIGN std::uint8_t codes[kMaxBlockVertices];
  float_codes(vertices, block.stride(), lower, upper, codes);
  return corner_codes(block, codes);
}

void float_octants(const BlockHeader& block, const float* vertices, const float (&box)[2][3],
                   const float (&middle)[2][3], OctantCodes::NearOctants& hits) {
  HWY_ALIGN std::uint8_t outcodes[kMaxBlockVertices], codes[kMaxBlockVertices];
  float_codes(vertices, block.stride(), box[0], box[1], outcodes);
  float_codes(vertices, block.stride(), middle[0], middle[1], codes);
  for (unsigned i = 0; i < block.stride(); ++i)
    hits.with_vertex |= outcodes[i] == 0 ? OctantCodes::kOctants[codes[i]] : 0U;
  shared_codes(block, codes, hits.by_box);
  const unsigned apart = corner_codes(block, outcodes).shared;
  for (unsigned i = 0; i < block.triangle_count; ++i)
    hits.by_box[i] = (apart >> i & 1) != 0 ? 0 : OctantCodes::kOctants[hits.by_box[i]];
}

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planetree::octree {

HWY_EXPORT(meeting_on_target);
HWY_EXPORT(subtrees_on_target);
HWY_EXPORT(add_within_on_target);
HWY_EXPORT(triangles_on_target);
HWY_EXPORT(corners_on_target);

unsigned children_meeting(const Node& node, const FloatBox& box) noexcept {
  return HWY_DYNAMIC_DISPATCH(meeting_on_target)(node, box);
}

std::uint64_t subtrees_meeting(const NearbySubtrees& list, const FloatBox& box) noexcept {
  return HWY_DYNAMIC_DISPATCH(subtrees_on_target)(list, box);
}

void add_children_within(const Node& node, const FloatQuery& query, float threshold,
                         NearbySubtrees& list) noexcept {
  assert(list.has_capacity());
  HWY_DYNAMIC_DISPATCH(add_within_on_target)(node, query, threshold, list);
}

unsigned triangles_within(const BlockView& block, const Point& point, const FloatQuery& wide,
                          double distance, double (&nearest)[kMaxBlockTriangles]) noexcept {
  // The block is too small or too large for float, or the query too far away.
  if (!can_filter(wide, block.header().extent)) {
    std::fill_n(nearest, block.triangle_count(), 0.0);
    unsigned within = 0;
    for (unsigned i = 0; i < block.triangle_count(); ++i)
      if (!is_beyond(block.triangle(i), point, wide, distance)) within |= 1U << i;
    return within;
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

namespace {

HWY_EXPORT(float_corner_codes);
HWY_EXPORT(float_octants);

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Returns the greatest float that is not above the value; not_below() returns the least that is not
// below it.
float not_above(double value) {
  const auto rounded = static_cast<float>(value);
  return rounded > value ? std::nextafter(rounded, -kInfinity) : rounded;
}
float not_below(double value) {
  const auto rounded = static_cast<float>(value);
  return rounded < value ? std::nextafter(rounded, kInfinity) : rounded;
}

unsigned all_of(const BlockView& block) { return (1U << block.triangle_count()) - 1; }

// Tests a triangle whose vertices are doubles. Returns 0 or 1.
unsigned has_corner_within(const Triangle& triangle, const Point& lower, const Point& upper) {
  for (const Point& corner : triangle)
    if ((corner.array() >= lower.array()).all() && (corner.array() <= upper.array()).all())
      return 1;
  return 0;
}

}  // namespace

Outcodes::Outcodes(const Point& lower, const Point& upper) noexcept
    : lower_(lower),
      upper_(upper),
      float_lower_{not_above(lower.x()), not_above(lower.y()), not_above(lower.z())},
      float_upper_{not_below(upper.x()), not_below(upper.y()), not_below(upper.z())} {}

unsigned Outcodes::with_corner_within(const BlockView& block) const noexcept {
  unsigned found = 0;
  if (const float* vertices = block.float_vertices())
    found = HWY_DYNAMIC_DISPATCH(float_corner_codes)(block.header(), vertices, float_lower_,
                                                     float_upper_)
                .none;
  else
    for (unsigned i = 0; i < block.triangle_count(); ++i)
      found |= has_corner_within(block.triangle(i), lower_, upper_) << i;
  return found & all_of(block);
}

OctantCodes::OctantCodes(const Point& lower, const Point& middle, const Point& upper) noexcept
    : box_{lower, upper}, middle_(middle) {
  for (unsigned axis = 0; axis < 3; ++axis) {
    float_box_[0][axis] = not_above(lower[axis]);
    float_box_[1][axis] = not_below(upper[axis]);
    float_middle_[0][axis] = not_above(middle[axis]);
    float_middle_[1][axis] = not_below(middle[axis]);
  }
}

OctantCodes::NearOctants OctantCodes::near_octants(const BlockView& block) const noexcept {
  NearOctants hits;
  if (const float* vertices = block.float_vertices()) {
    HWY_DYNAMIC_DISPATCH(float_octants)(block.header(), vertices, float_box_, float_middle_, hits);
    return hits;
  }
  for (unsigned i = 0; i < block.triangle_count(); ++i) {
    const Triangle triangle = block.triangle(i);
    const Point least = least_corner(triangle), greatest = greatest_corner(triangle);
    const bool apart =
        (greatest.array() < box_[0].array()).any() || (least.array() > box_[1].array()).any();
    hits.by_box[i] = apart ? 0 : kOctants[code(greatest, least)];
    for (const Point& corner : triangle)
      if (((corner.array() >= box_[0].array()) && (corner.array() <= box_[1].array())).all())
        hits.with_vertex |= kOctants[code(corner, corner)];
  }
  return hits;
}

// A triangle is below the middle if its greatest coordinate is, and above it if its least
// coordinate is.
unsigned OctantCodes::code(const Point& greatest, const Point& least) const {
  unsigned code = 0;
  for (unsigned axis = 0; axis < 3; ++axis) {
    code |= static_cast<unsigned>(greatest[axis] < middle_[axis]) << (2 * axis);
    code |= static_cast<unsigned>(least[axis] > middle_[axis]) << (2 * axis + 1);
  }
  return code;
}

}  // namespace planetree::octree
#endif
