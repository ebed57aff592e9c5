#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "octree/builder/surface/edge_sum.h"
#include "octree/geometry/triangle_distance.h"
#include "storage/file/file_layout.h"

namespace planetree::tools {

/// Checks the header's unbalanced edges against all triangles, in any order. Sums over edges show
/// whether the surface is watertight, and whether an edge that must be listed is not. Triangles at
/// listed edges are counted. The number of unbalanced edges is checked where there are at most
/// kMaxCounted triangles.
///
/// memory  48 bytes for each triangle, if there are at most kMaxCounted
class EdgeCheck {
 public:
  static constexpr std::uint64_t kMaxCounted = std::uint64_t{1} << 20;

  /// Converts the coordinates of `model` to the model frame. `model` must outlive this.
  explicit EdgeCheck(const storage::ModelRecord& model);

  /// Adds a triangle, model frame. Each triangle of the model must be added once.
  void add(const octree::Triangle& triangle, std::uint64_t index);
  /// Adds a cap, of which no edge is listed.
  void add_cap(const octree::Triangle& cap) { edges_.add(cap); }
  /// What is wrong with the header. Empty if nothing is.
  [[nodiscard]] std::optional<std::string> finding();
  /// Whether these triangles and others, such as caps, are watertight together.
  [[nodiscard]] bool are_closed_by(const EdgeCheck& others) const {
    octree::EdgeSum sum = edges_;
    sum.add(others.edges_);
    return sum.is_watertight();
  }

 private:
  /// The ends of an edge, the lesser first.
  using Ends = std::array<double, 6>;
  /// A triangle that has an edge, and the corner where the edge begins in it.
  struct EdgeUse {
    std::uint64_t triangle = storage::kNoTriangle;
    unsigned corner = 3;
    bool is_along = false;  // from the listed edge's start to its end
    auto operator<=>(const EdgeUse&) const = default;
  };
  struct ListedEdge {
    octree::Point from, to;
    std::uint64_t along = 0, against = 0;
    EdgeUse first;  // the least
  };

  void count(const octree::Point& from, const octree::Point& to, EdgeUse use);
  std::optional<std::string> finding_of(std::size_t i) const;
  std::uint64_t count_unbalanced();
  static Ends ends_of(const octree::Point& a, const octree::Point& b);

  const storage::ModelRecord& model_;
  const bool are_counted_;
  std::vector<ListedEdge> listed_;
  Ends greatest_{};         // of the listed edges
  octree::EdgeSum edges_;   // all
  octree::EdgeSum lesser_;  // those that are not listed and would be, if they were unbalanced
  std::vector<std::pair<std::uint64_t, std::int8_t>> ways_;  // hash of ends, direction
};

}  // namespace planetree::tools
