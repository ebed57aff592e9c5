#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "octree/triangle_distance.h"
#include "storage/file_layout.h"

namespace planetree::tools {

/// Checks what a header says of open edges against all triangles, in any order
/// and in constant memory: every edge adds a hash of its ends one way and takes
/// it away the other, so that the sum is zero if and, but for one case in 2^128,
/// only if the surface is watertight. Listed edges are counted besides.
class EdgeCheck {
 public:
  /// Coordinates of `model` are taken to the model frame.
  explicit EdgeCheck(const storage::ModelRecord& model);

  /// Model frame; each triangle of the model once.
  void add(const octree::Triangle& triangle);
  /// What the header says that is not so; nothing if it is right.
  [[nodiscard]] std::optional<std::string> finding() const;

 private:
  void add_edge(const octree::Point& from, const octree::Point& to);

  struct Counted {
    octree::Point from, to;
    std::uint64_t along = 0, against = 0;
  };
  const storage::ModelRecord& model_;
  std::array<Counted, 3> listed_;
  std::uint64_t sum_[2] = {};  // modulo 2^128, low word first
};

}  // namespace planetree::tools
