#pragma once

#include <vector>

#include "octree/builder/sort/morton_order.h"
#include "octree/builder/sort/triangles.h"
#include "octree/builder/tree/wide_tree.h"
#include "octree/page/moments.h"

namespace planetree::octree {

/// Integrals over triangles: n is the unit normal, x is relative to a point near the triangles.
struct SurfaceSums {
  Point vector = Point::Zero();                     ///< integral of n
  Eigen::Matrix3d first = Eigen::Matrix3d::Zero();  ///< integral of x n^T
  double area = 0;                                  ///< integral of 1, rounded up
  Point position = Point::Zero();                   ///< integral of x
  double second = 0;                                ///< integral of |x|^2, rounded up

  void add(const SurfaceSums& other);
  /// Changes the reference point: every x becomes x + `by`.
  void move(const Point& by);
};

/// Rounds a child's moments to what is stored.
///
/// sums  about the centre of the child's decoded box.
Moments packed(const SurfaceSums& sums, const FloatBox& box);

struct TreeMoments {
  std::vector<NodeMoments> nodes;  ///< moments of the children, by node
  SurfaceSums root;                ///< about the centre of the root's box
};

/// Computes the moments of a tree. A child's sums are those of its triangles, or of its own
/// children, in their order; so the result depends on the tree alone.
///
/// centre  centre of the model; boxes are relative to it.
/// box     box of the root.
TreeMoments sum_moments(const Triangles& mesh, const Point& centre,
                        const std::vector<MortonKey>& keys, const WideTree& tree,
                        const FloatBox& box);

}  // namespace planetree::octree
