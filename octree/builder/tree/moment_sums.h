#pragma once

#include <vector>

#include "octree/builder/sort/morton_order.h"
#include "octree/builder/sort/triangles.h"
#include "octree/builder/tree/wide_tree.h"
#include "octree/page/moments.h"

namespace planetree::octree {

/// Integrals over some triangles, x being relative to a point near them.
struct SurfaceSums {
  Point vector = Point::Zero();                     ///< of the normal n
  Eigen::Matrix3d first = Eigen::Matrix3d::Zero();  ///< of x n^T
  double area = 0;                                  ///< of 1, rounded up
  Point position = Point::Zero();                   ///< of x
  double second = 0;                                ///< of |x|^2, rounded up

  void add(const SurfaceSums& other);
  /// Makes every x larger by `by`.
  void move(const Point& by);
};

/// A child's moments, rounded to what is stored.
///
/// sums  about the centre of the child's decoded box.
Moments packed(const SurfaceSums& sums, const FloatBox& box);

struct TreeMoments {
  std::vector<NodeMoments> nodes;  ///< of every node's children, by node
  SurfaceSums root;                ///< about the centre of the root's box
};

/// The moments of a tree. A child's sums are those of its triangles, or of its own children,
/// in their order; so the result depends on the tree alone.
///
/// centre  of the model; boxes are relative to it.
/// box     the root's.
TreeMoments sum_moments(const Triangles& mesh, const Point& centre,
                        const std::vector<MortonKey>& keys, const WideTree& tree,
                        const FloatBox& box);

}  // namespace planetree::octree
