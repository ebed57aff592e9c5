#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "planetree/model.h"
#include "planetree/types.h"
#include "query/shell/signed_bounds.h"
#include "query/shell/sphere_tree.h"
#include "query/shell/vectors.h"

namespace planetree::query {

/// What a query told of the centre of a sphere, or of a point.
struct Known {
  Vec3 at;  ///< where it was, model frame
  SignedBounds bounds;

  /// The bounds where it is now.
  SignedBounds moved(const Vec3& to, SignRule rule) const {
    return bounds.moved(upper_length(to - at), rule);
  }
};

/// A point that may be in contact.
struct ShellHit {
  std::uint32_t point = 0;  ///< position in SphereTree::points()
  bool is_proven = false;
  Vec3 position;   ///< model frame
  Vec3 direction;  ///< of the force
  double depth = 0, depth_lower = 0, depth_upper = 0;
};

/// The implementation of PointShellState. Queries allocate nothing, because every array has its
/// greatest size from the start.
class ShellMemory {
 public:
  /// A leaf whose points are to be queried.
  struct Leaf {
    double lowest = 0;  ///< lower bound of the signed distances of its points
    std::uint32_t node = 0;
  };

  /// Throws std::bad_alloc.
  ShellMemory(const SphereTree& shell, const ModelInfo& info)
      : tree(shell),
        model(info),
        nodes(shell.nodes().size()),
        points(shell.points().size()),
        bounds(shell.nodes().size()) {
    queue.reserve(shell.nodes().size());
    leaves.reserve(shell.nodes().size());
    hits.resize(shell.points().size());
    hits.clear();
  }

  /// Forgets what is known, if other sides or depths are asked for than before.
  void begin(SignRule rule, SideRule side_rule) {
    if (rule != rule_ || side_rule != side_rule_) forget();
    rule_ = rule;
    side_rule_ = side_rule;
    queue.clear();
    leaves.clear();
    hits.clear();
  }
  void forget() {
    std::ranges::fill(nodes, Known{});
    std::ranges::fill(points, Known{});
  }

  const SphereTree& tree;
  const ModelInfo& model;

  std::vector<Known> nodes;   ///< from call to call
  std::vector<Known> points;  ///< from call to call

  std::vector<SignedBounds> bounds;  ///< of the nodes in the queue, this call
  std::vector<std::uint32_t> queue;  ///< nodes to examine, this call
  std::vector<Leaf> leaves;          ///< this call
  std::vector<ShellHit> hits;        ///< this call

 private:
  SignRule rule_ = SignRule::kContinuous;
  SideRule side_rule_ = SideRule::kOfFile;
};

}  // namespace planetree::query
