#pragma once

#include <cstdint>

#include "octree/geometry/rigid_transform.h"
#include "planetree/point_shell.h"
#include "query/shell/shell_memory.h"
#include "query/shell/signed_bounds.h"
#include "query/shell/sphere_tree.h"

namespace planetree::query {

/// A model, as a shell asks it. See the functions of Probe.
class ShellSource {
 public:
  virtual ~ShellSource() = default;

  virtual ClosestPoint closest_point(const Vec3& query, const QueryOptions& options) noexcept = 0;
  virtual Containment contains(const Vec3& query, const QueryOptions& options) noexcept = 0;
  virtual std::uint64_t work_spent() const noexcept = 0;
  virtual const ModelInfo& info() const noexcept = 0;
};

/// The place of a tool in the frame of a model.
struct ToolPlace {
  octree::RigidTransform transform;
  /// Bounds on errors besides those of the transform: of positions, model units, and of directions,
  /// as a share of their length.
  double position_error = 0, rotation_error = 0;
};

/// Whether the members are in range.
bool is_valid(const ShellOptions& options);

/// Finds the points of a shell that may be in contact, from coarse to fine.
class ShellQuery {
 public:
  /// options  in range
  ShellQuery(ShellSource& source, ShellMemory& memory, const ToolPlace& place,
             const ShellOptions& options);

  /// Writes the points that may be in contact to ShellMemory::hits, in any order.
  void run();

  std::size_t queries() const { return queries_; }
  std::uint64_t work() const { return work_; }

 private:
  using Node = SphereTree::Node;

  bool has_work() const { return work_ < max_work_; }
  template <class Query>
  auto limited(QueryOptions options, const Query& query);
  ClosestPoint ask(const Vec3& at, const QueryOptions& options);
  Side ask_side(const Vec3& at);

  void examine(std::uint32_t node);
  bool settle(const Node& node, const Vec3& centre, const SignedBounds& bounds, double radius);
  bool may_settle(const SignedBounds& bounds, double radius) const;
  void ask_centre(const Node& node, const Vec3& centre, SignedBounds& bounds);
  void descend(std::uint32_t node, const Vec3& centre, const SignedBounds& bounds);

  void add_candidates(const Node& node, const Vec3& centre, const SignedBounds& bounds);
  void examine_point(const Candidate& candidate);
  ClosestPoint ask_point(const Vec3& at, const SignedBounds& bounds, Side& side);
  bool settle(std::uint32_t point, const Vec3& at, const SignedBounds& bounds);
  void add_full(std::uint32_t point, const Vec3& at);
  void add(std::uint32_t point, const Vec3& at, const SignedBounds& bounds, bool is_proven,
           const Vec3& direction);
  double depth_at(double distance, double slack) const;

  ShellSource& source_;
  ShellMemory& memory_;
  const SphereTree& tree_;
  const octree::RigidTransform& transform_;
  const ShellOptions& options_;
  const SideRule side_rule_;  // not kOfFile
  const SignRule sign_rule_;
  const bool is_limited_;
  const std::uint64_t max_work_;
  const double position_error_;  // of a point, by its pose
  // Signed distances above it are free of contact, those below full_ are as deep as max_depth, by
  // more than an exact answer errs. So no result depends on how that was found.
  double free_ = 0, full_ = 0;
  double free_search_ = 0, full_search_ = 0;  // max_distance of queries outside, and inside
  std::uint64_t work_ = 0;
  std::size_t queries_ = 0;
};

}  // namespace planetree::query
