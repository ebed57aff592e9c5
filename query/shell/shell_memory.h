#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

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

/// A point that is to be queried.
struct Candidate {
  std::uint32_t point = 0;  ///< position in SphereTree::points()
  int urgency = 0;          ///< power of two of what is not known of its depth
  Vec3 at;                  ///< model frame
  SignedBounds bounds;      ///< known without a query
};

/// A point that may be in contact.
struct ShellHit {
  std::uint32_t point = 0;  ///< position in SphereTree::points()
  bool is_proven = false;
  Vec3 position;   ///< model frame
  Vec3 direction;  ///< of the force
  double depth = 0, depth_lower = 0, depth_upper = 0;
};

/// What is known of the points of one shell in one model. Queries allocate nothing, because every
/// array has its greatest size from the start.
class ShellMemory {
 public:
  /// Throws std::bad_alloc.
  explicit ShellMemory(const SphereTree& shell)
      : tree(shell),
        nodes(shell.nodes().size()),
        points(shell.points().size()),
        bounds(shell.nodes().size()) {
    // Writes to all memory.
    queue.resize(shell.nodes().size());
    candidates.resize(shell.points().size());
    hits.resize(shell.points().size());
  }

  /// Forgets what is known, if other sides or depths are asked for than before.
  void begin(SignRule rule, SideRule side_rule) {
    if (rule != rule_ || side_rule != side_rule_) forget();
    rule_ = rule;
    side_rule_ = side_rule;
    queue.clear();
    candidates.clear();
    hits.clear();
  }
  void forget() {
    std::ranges::fill(nodes, Known{});
    std::ranges::fill(points, Known{});
  }

  const SphereTree& tree;

  std::vector<Known> nodes;   ///< from call to call
  std::vector<Known> points;  ///< from call to call

  // Of one call.
  std::vector<std::uint32_t> queue;  ///< nodes to examine
  std::vector<SignedBounds> bounds;  ///< of the nodes in the queue
  std::vector<Candidate> candidates;
  std::vector<ShellHit> hits;

 private:
  SignRule rule_ = SignRule::kContinuous;
  SideRule side_rule_ = SideRule::kOfFile;
};

}  // namespace planetree::query
