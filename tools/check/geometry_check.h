#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <unordered_map>

#include "octree/geometry/child_bounds.h"
#include "octree/page/block_view.h"
#include "octree/page/moments.h"
#include "storage/file/file_layout.h"
#include "tools/check/edge_check.h"
#include "tools/check/file_check.h"

namespace planetree::tools {

/// What a node says of a child, and what was said above of all that holds it.
/// Boxes lie within each other, so the innermost speaks for all; planes do not.
struct Bounds {
  octree::FloatBox box;
  octree::Disc disc;
  octree::Moments moments;              ///< zeros where there are none
  std::shared_ptr<const Bounds> above;  ///< null below the root
};

/// Checks triangle after triangle, in double, what float bounds promise of
/// them; and at the end what the header promises of all.
class GeometryCheck {
 public:
  GeometryCheck(const storage::FileHeader& header, IssueList& issues);

  /// bounds  of the block; null if it is the whole tree.
  void add(const octree::BlockView& block, std::uint32_t page, const Bounds* bounds);
  /// A node whose own moments, stated above it, are to be held against those it
  /// states of its children.
  void add_node(const octree::Node& node, std::uint32_t page, const Bounds& bounds);
  /// complete  whether every block has been added.
  void finish(bool complete);

 private:
  void add_triangle(const octree::Triangle& triangle, std::uint32_t page);
  void add_ids(const octree::BlockView& block, std::uint32_t page);
  void look_for_sample(const octree::BlockView& block, unsigned triangle, std::uint32_t page);
  void check_vertices(const octree::BlockView& block, std::uint32_t page, const Bounds& bounds);
  bool insert(std::uint64_t id);
  bool is_box(double lower, double upper, int axis) const;
  void report(IssueCode code, std::uint32_t page, std::string message);

  const storage::ModelRecord& model_;
  IssueList& issues_;
  // Bits of triangles seen, in pieces, so that the file's claims cost nothing.
  std::unordered_map<std::uint64_t, std::array<std::uint64_t, 8>> seen_;
  std::uint64_t min_id_ = storage::kNoTriangle;
  bool sample_seen_ = false;
  EdgeCheck edges_;
  octree::Point lower_, upper_;            // of all vertices, model frame
  octree::Point part_lower_, part_upper_;  // of the region, as far as it is in the model's box
  bool cut_off_ = false;                   // triangles may have been left out
};

}  // namespace planetree::tools
