#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "octree/builder/surface/edge_sum.h"
#include "octree/geometry/triangle_distance.h"
#include "storage/file/file_layout.h"

namespace planetree::tools {

/// Checks the header's unbalanced edges against all triangles, in any order and in constant memory.
/// A sum over all edges shows whether the surface is watertight. Triangles at listed edges are
/// counted.
class EdgeCheck {
 public:
  /// Converts the coordinates of `model` to the model frame. `model` must outlive this.
  explicit EdgeCheck(const storage::ModelRecord& model);

  /// Adds a triangle, model frame. Each triangle of the model must be added once.
  void add(const octree::Triangle& triangle);
  /// What is wrong with the header. Empty if nothing is.
  [[nodiscard]] std::optional<std::string> finding() const;
  /// Whether these triangles and others, such as caps, are watertight together.
  [[nodiscard]] bool are_closed_by(const EdgeCheck& others) const {
    octree::EdgeSum sum = edges_;
    sum.add(others.edges_);
    return sum.is_watertight();
  }

 private:
  void count(const octree::Point& from, const octree::Point& to);

  struct ListedEdge {
    octree::Point from, to;
    std::uint64_t along = 0, against = 0;
  };
  const storage::ModelRecord& model_;
  std::array<ListedEdge, 3> listed_;
  octree::EdgeSum edges_;
};

}  // namespace planetree::tools
