#include "octree/builder/mask/height_field_finder.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <span>

#include <Eigen/Geometry>

#include "octree/builder/mask/prism_filter.h"
#include "octree/geometry/cell_grid.h"
#include "octree/geometry/predicates.h"
#include "octree/geometry/strict_math.h"
#include "octree/nearest/height_field.h"
#include "octree/traversal/tree_walk.h"
#include "octree/winding/crossings.h"

namespace planetree::octree {
namespace {

/// Maximum number of records to visit. Boxes with more belong to blocks far larger than others.
constexpr std::uint64_t kMaxRecords = 1024;
/// The ends of a prism are this many of its widths beyond its block, and its sides this share.
constexpr double kEnds = 1;
constexpr double kPrismSideShare = 0x1p-16;
/// Minimum distance from the ends of what is between them, so that no rounding brings it beyond:
/// coordinates are below kMaxPrismCoordinate, so that they err by 2^-37.
constexpr double kPrismClearance = HeightField::kRim / 2;
/// With larger coordinates, a rim would be lost to rounding.
constexpr double kMaxPrismCoordinate = 0x1p16;
/// Edges shorter than this share of their triangle's distance are lost to rounding: at this length
/// a normal errs by 2^-29.
constexpr double kMinPrismSideShare = 0x1p-24;

/// A box around a block, upright on it, and the line through its middle.
class Prism {
 public:
  explicit Prism(const BlockView& block) : origin_(block.vertex(0)) {
    Point normals = Point::Zero();
    for (unsigned i = 0; i < block.triangle_count(); ++i) {
      const Triangle triangle = block.triangle(i);
      normals += (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
    }
    const double length = normals.norm();
    if (!(length > 0)) return;
    rotated_.row(2) = normals / length;
    Eigen::Index least;
    normals.cwiseAbs().minCoeff(&least);
    const Point across = Point::Unit(least).cross(normals).normalized();
    rotated_.row(0) = across;
    rotated_.row(1) = normals.cross(across) / length;
    for (unsigned i = 1; i < block.header().vertex_count(); ++i) {
      const Point at = rotated(block.vertex(i));
      lower_ = lower_.cwiseMin(at);
      upper_ = upper_.cwiseMax(at);
    }
    const double width = std::max(upper_[0] - lower_[0], upper_[1] - lower_[1]);
    const double rim = HeightField::kRim + kPrismSideShare * width;
    const Point beyond(rim, rim, rim + kEnds * width);
    lower_ -= beyond;
    upper_ += beyond;
    middle_ = (lower_ + upper_) * 0.5;
  }

  /// Coordinates from the block's first vertex; the last component points to the block's front.
  Point rotated(const Point& point) const { return rotated_ * (point - origin_); }

  Triangle rotated(const Triangle& triangle) const {
    return {rotated(triangle[0]), rotated(triangle[1]), rotated(triangle[2])};
  }

  bool is_good() const {
    return rotated_.row(2).squaredNorm() > 0 &&
           (box_centre().cwiseAbs() + box_half()).maxCoeff() < kMaxPrismCoordinate;
  }
  /// The middle line, from the end in front to the end behind.
  PerturbedSegment middle_line() const {
    Point from = middle_, to = middle_;
    from[2] = upper_[2];
    to[2] = lower_[2];
    return {back(from), back(to)};
  }
  /// Centre of the axis-parallel box around the prism, model frame.
  Point box_centre() const { return back(middle_); }
  Point box_half() const { return rotated_.transpose().cwiseAbs() * ((upper_ - lower_) * 0.5); }

  /// Whether the box of a triangle in the prism's frame does not meet the prism.
  bool misses(const Triangle& rotated) const {
    return (least_corner(rotated).array() > upper_.array()).any() ||
           (greatest_corner(rotated).array() < lower_.array()).any();
  }

  /// Whether a triangle in the prism's frame does not meet the prism, or is between the ends with
  /// its front towards the first end and meets the limits of HeightField.
  bool accepts(const Triangle& rotated) const {
    if (misses(rotated)) return true;
    const auto& [a, b, c] = rotated;
    const auto [least, greatest] = std::minmax({a.z(), b.z(), c.z()});
    if (!(least > lower_.z() + kPrismClearance && greatest < upper_.z() - kPrismClearance))
      return false;
    const Point u = b - a, v = c - a, w = c - b;
    const Point normal = u.cross(v);
    const double normal2 = normal.squaredNorm();
    const double u2 = u.squaredNorm(), v2 = v.squaredNorm(), w2 = w.squaredNorm();
    const double shortest = std::min({u2, v2, w2}), longest = std::max({u2, v2, w2});
    const double other = u2 + v2 + w2 - shortest - longest;
    constexpr double kSine2 = HeightField::kMinSine * HeightField::kMinSine;
    constexpr double kRise2 = HeightField::kMinRise * HeightField::kMinRise;
    const double reach2 = a.squaredNorm() + longest;
    return shortest > kMinPrismSideShare * kMinPrismSideShare * reach2 &&
           normal2 > kSine2 * other * longest && normal.z() > 0 &&
           normal.z() * normal.z() > kRise2 * normal2;
  }
  FloatPrism in_float() const {
    FloatPrism prism;
    for (Eigen::Index row = 0; row < 3; ++row) {
      const auto at = static_cast<std::size_t>(row);
      for (Eigen::Index k = 0; k < 3; ++k)
        prism.rotated[at][static_cast<std::size_t>(k)] = static_cast<float>(rotated_(row, k));
      prism.lower[at] = static_cast<float>(lower_[row]);
      prism.upper[at] = static_cast<float>(upper_[row]);
    }
    prism.clear = static_cast<float>(kPrismClearance);
    prism.middle = {static_cast<float>(middle_.x()), static_cast<float>(middle_.y())};
    return prism;
  }
  const Point& origin() const { return origin_; }

 private:
  Point back(const Point& rotated) const { return origin_ + rotated_.transpose() * rotated; }

  const Point origin_;
  Eigen::Matrix3d rotated_ = Eigen::Matrix3d::Zero();
  Point lower_ = Point::Zero(), upper_ = Point::Zero(), middle_ = Point::Zero();
};

/// Whether accepts(triangle in the prism's frame) holds for all triangles of a set.
template <class Accepts>
bool all_of(const BlockView& block, const Prism& prism, unsigned set, const Accepts& accepts) {
  for (; set != 0; set &= set - 1)
    if (!accepts(prism.rotated(block.triangle(static_cast<unsigned>(std::countr_zero(set))))))
      return false;
  return true;
}

/// Whether all triangles of a block that meet a prism suit it.
bool all_accepted(const BlockView& block, const Prism& prism, const PrismTriangles& found) {
  return all_of(block, prism, found.met & ~found.rising,
                [&](const Triangle& rotated) { return prism.accepts(rotated); });
}

/// The winding number of a point that no triangle touches. Nothing where the mask does not tell it;
/// of a black or inverted cell the mask tells only the sign.
std::optional<std::int64_t> winding_at(const TreeInfo& tree, const MaskInfo& mask,
                                       const Point& point, const PageReader& pages,
                                       TraversalStats& work) {
  if ((point.array() < tree.box_lower.array()).any() ||
      (point.array() > tree.box_upper.array()).any())
    return 0;
  const MaskLookup found = look_up(mask, point, kMaxRecords, pages, work);
  if (found.kind == MaskLookup::Kind::kPlanes) return found.winding;
  if (found.kind == MaskLookup::Kind::kColour && found.winding == 0) return 0;
  if (found.kind != MaskLookup::Kind::kCorners || found.blocks.count == 0) return std::nullopt;
  const CellGrid grid(mask.lower);
  const unsigned octant = grid.octant(found.cell, point);
  std::array<std::uint32_t, kMaxListed> links;
  const unsigned count = found.blocks.in_octant(octant, links);
  const Crossings crossings =
      count_crossings(tree, {point, grid.corner(found.cell, octant)}, std::span(links).first(count),
                      kMaxRecords, pages, work);
  if (!crossings.complete) return std::nullopt;
  return corner_number(found.listed, octant) + crossings.difference;
}

}  // namespace

bool HeightFieldFinder::may_be_height_field(const BlockView& block) {
  const Prism prism(block);
  return prism.is_good() &&
         all_accepted(block, prism, classify_triangles(block, prism.in_float(), prism.origin()));
}

bool HeightFieldFinder::is_height_field(const BlockView& block, const PageReader& pages,
                                        TraversalStats& work) const {
  const Prism prism(block);
  if (!prism.is_good()) return false;
  const Point centre = prism.box_centre(), half = prism.box_half();
  const FloatPrism in_float = prism.in_float();
  const PerturbedSegment line = prism.middle_line();
  bool accepts = true;
  std::int64_t difference = 0;
  const auto look_at = [&](const BlockView& near, std::uint32_t) {
    const PrismTriangles found = classify_triangles(near, in_float, prism.origin());
    accepts = all_accepted(near, prism, found);
    for (unsigned middle = found.met & found.middle; middle != 0; middle &= middle - 1)
      difference += crossing(line, near.triangle(static_cast<unsigned>(std::countr_zero(middle))));
  };
  // The line crosses all accepted triangles from the front, so that the difference only falls.
  bool complete = BoxWalk(tree_, centre - half, centre + half, pages, work)
                      .run_while(kMaxRecords, look_at, [&] { return accepts && difference >= -1; });
  const auto look_at_caps = [&](const BlockView& near, std::uint32_t) {
    // In float, caps of strays may overflow and then seem to meet every prism.
    accepts = all_of(near, prism, classify_triangles(near, in_float, prism.origin()).met,
                     [&](const Triangle& rotated) { return prism.misses(rotated); });
  };
  if (complete && accepts && tree_.caps)
    complete = BoxWalk(*tree_.caps, centre - half, centre + half, pages, work)
                   .run_while(kMaxRecords, look_at_caps, [&] { return accepts; });
  // The winding number behind is one more than that in front.
  return complete && accepts && difference == -1 &&
         winding_at(tree_, mask_, line.from, pages, work) == 0;
}

}  // namespace planetree::octree
