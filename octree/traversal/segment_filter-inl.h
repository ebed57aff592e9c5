// Finds the triangles of a block that are near a segment, in float.

#if defined(PLANETREE_OCTREE_SEGMENT_FILTER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANETREE_OCTREE_SEGMENT_FILTER_INL_H_
#undef PLANETREE_OCTREE_SEGMENT_FILTER_INL_H_
#else
#define PLANETREE_OCTREE_SEGMENT_FILTER_INL_H_
#endif

#include <algorithm>

#include "octree/geometry/triangle_distance.h"
#include "octree/traversal/segment_kernels-inl.h"
#include "octree/traversal/tree_view.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {

// The triangles of a block within a margin of a segment.
class SegmentFilter {
 public:
  SegmentFilter(const TreeInfo& tree, const Point& from, const Point& to, double margin = 0)
      : origin_(tree.shape.float64 ? tree.centre : Point(Point::Zero())),
        largest_(largest_coordinate(tree.core_lower, tree.core_upper)),
        has_strays_(tree.has_strays),
        core_(FloatSegment::between(from, to, origin_, largest_, margin)),
        stray_(has_strays_ ? FloatSegment::between(
                                 from, to, origin_,
                                 largest_coordinate(tree.box_lower, tree.box_upper), margin)
                           : core_) {}

  // Returns a bit for each triangle that may be met.
  unsigned met_in(const BlockView& block) const {
    const FloatSegment& segment = is_stray(block) ? stray_ : core_;
    if (const float* vertices = block.float_vertices())
      return triangles_met(block.header(), vertices, segment);
    unsigned found = 0;
    for (unsigned i = 0; i < block.triangle_count(); ++i)
      found |= (meets(segment, block.triangle(i)) ? 1U : 0U) << i;
    return found;
  }

 private:
  double largest_coordinate(const Point& lower, const Point& upper) const {
    return std::max((lower - origin_).cwiseAbs().maxCoeff(),
                    (upper - origin_).cwiseAbs().maxCoeff());
  }
  // Whether a vertex of a block may have a greater coordinate than any of the core.
  bool is_stray(const BlockView& block) const {
    return has_strays_ && (block.vertex(0) - origin_).cwiseAbs().maxCoeff() +
                                  static_cast<double>(block.header().extent) >
                              largest_;
  }

  // Does what children_met() does, for the box of a triangle in double.
  bool meets(const FloatSegment& segment, const Triangle& triangle) const {
    const Point lower = least_corner(triangle) - origin_;
    const Point upper = greatest_corner(triangle) - origin_;
    const double first = std::max(lower[segment.axis], double{segment.lower});
    const double last = std::min(upper[segment.axis], double{segment.upper});
    if (first > last) return false;
    for (const FloatSegment::CrossAxis& cross_axis : segment.cross_axes) {
      const double slope = cross_axis.slope;
      const double least = std::min(slope * first, slope * last) + double{cross_axis.lowest};
      const double greatest = std::max(slope * first, slope * last) + double{cross_axis.highest};
      if (lower[cross_axis.axis] > greatest || upper[cross_axis.axis] < least) return false;
    }
    return true;
  }

  // Blocks of float vertices are tested where they are, others relative to the model's centre:
  // differences of doubles lose nothing there.
  const Point origin_;
  const double largest_;
  const bool has_strays_;
  const FloatSegment core_, stray_;
};

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#endif
