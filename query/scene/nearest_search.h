#pragma once

#include <cstddef>
#include <limits>

#include "planetree/scene.h"
#include "planetree/types.h"
#include "query/scene/scene_probe.h"

namespace planetree::query {

/// The search for the instance nearest to a point: best first, by the bounds of their boxes. An
/// instance is asked for surface no farther than the best point so far.
class SceneProbeState::NearestSearch {
 public:
  /// For a query in a section of the probe.
  NearestSearch(SceneProbeState& scene, const Vec3& query, const QueryOptions& options) noexcept;

  SceneClosestPoint run() noexcept;

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  std::size_t first() const noexcept;
  void visit(std::size_t index, std::uint32_t parts) noexcept;
  ClosestPoint ask(std::size_t index, std::uint32_t parts, double max_distance) noexcept;
  void offer(std::size_t index, const ClosestPoint& answer, std::uint32_t parts) noexcept;
  bool is_better(const ClosestPoint& answer, std::size_t index) const noexcept;
  bool may_stop(double bound) const noexcept;
  SceneClosestPoint finish() noexcept;

  SceneProbeState& scene_;
  InstanceView& view_;
  const Vec3 query_;
  QueryOptions options_;          // with the work that is left
  ClosestPoint best_;             // of least distance; its interval is that of its instance
  std::size_t best_index_;        // size(): none yet
  std::uint32_t best_parts_ = 0;  // that were computed for it
  double lower_ = kInfinity;      // of the distance to all instances
  double upper_ = kInfinity;
  double unproven_ = kInfinity;  // lower bound of the instances of which more may be found
};

}  // namespace planetree::query
