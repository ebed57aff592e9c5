#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "octree/builder/surface/edge_sum.h"
#include "octree/geometry/triangle_distance.h"
#include "storage/file/file_layout.h"

namespace planetree::tools {

/// Checks what a header says of open edges against all triangles, in any order
/// and in constant memory: by the sum of all edges; those listed are counted.
class EdgeCheck {
 public:
  /// Coordinates of `model` are taken to the model frame.
  explicit EdgeCheck(const storage::ModelRecord& model);

  /// Model frame; each triangle of the model once.
  void add(const octree::Triangle& triangle);
  /// What the header says that is not so; nothing if it is right.
  [[nodiscard]] std::optional<std::string> finding() const;

 private:
  void count(const octree::Point& from, const octree::Point& to);

  struct Counted {
    octree::Point from, to;
    std::uint64_t along = 0, against = 0;
  };
  const storage::ModelRecord& model_;
  std::array<Counted, 3> listed_;
  octree::EdgeSum edges_;
};

}  // namespace planetree::tools
