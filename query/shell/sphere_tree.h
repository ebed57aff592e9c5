#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "planetree/point_shell.h"
#include "planetree/types.h"

namespace planetree::query {

/// The points of a shell and a tree of spheres around them. The children of a node follow all nodes
/// of its level, so that the order of the nodes is from coarse to fine. The points of a node are
/// neighbours in the array of points.
class SphereTree {
 public:
  /// Maximum number of points of a leaf, and of children of a node.
  static constexpr std::uint32_t kMaxLeafPoints = 6, kMaxChildren = 4;

  struct Node {
    Vec3 centre;
    double radius = 0;  ///< at least the distance of each point of the node from the centre
    std::uint32_t first = 0, count = 0;           ///< points
    std::uint32_t first_child = 0, children = 0;  ///< nodes; none: a leaf
  };
  struct Point {
    Vec3 position;
    Vec3 normal;               ///< of length 1, rounded
    std::uint32_t number = 0;  ///< position in the points of PointShell::create
  };

  /// The points must be in range; see ShellPoint. Throws std::bad_alloc.
  explicit SphereTree(std::span<const ShellPoint> points);

  std::span<const Node> nodes() const noexcept { return nodes_; }
  std::span<const Point> points() const noexcept { return points_; }
  /// At least the distance of every point and centre from the origin.
  double reach() const noexcept { return reach_; }
  /// Greatest radius of a leaf.
  double leaf_radius() const noexcept { return leaf_radius_; }
  /// Bound on the distance of a stored normal from the given one, whether that is divided by its
  /// length or not.
  double normal_error() const noexcept { return normal_error_; }

 private:
  void bound(Node& node) const;
  void divide(std::size_t node);

  std::vector<Node> nodes_;
  std::vector<Point> points_;
  double reach_ = 0;
  double leaf_radius_ = 0;
  double normal_error_ = 0;
};

}  // namespace planetree::query
