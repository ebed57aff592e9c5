#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>

#include "octree/geometry/area_sums.h"
#include "octree/geometry/child_bounds.h"
#include "octree/page/frame.h"
#include "octree/page/moments.h"
#include "storage/file/file_layout.h"
#include "tools/check/edge_check.h"
#include "tools/check/file_check.h"
#include "tools/check/page_keys.h"

namespace planetree::tools {

/// Bounds that a node states for a child, linked to the bounds that nodes above state. Boxes are
/// nested, so that the innermost implies the others. Discs are not, so that each must be checked.
struct Bounds {
  octree::FloatBox box;
  octree::Disc disc;
  octree::Moments moments;              ///< zeros where there are none
  std::shared_ptr<const Bounds> above;  ///< null below the root
  std::uint32_t subtree = 0;            ///< PageKeys: the one that begins here; 0: none does
};

/// Checks in double that the stated float bounds hold for every triangle, and in the end the
/// root's box, and the header's box, sample, unbalanced edges and openness.
class GeometryCheck {
 public:
  /// of_caps  checks the tree of caps, not the surface
  GeometryCheck(const storage::FileHeader& header, IssueList& issues, bool of_caps = false);

  /// Checks a block.
  ///
  /// bounds  stated for the block; null if the block is the whole tree
  void add(const octree::BlockView& block, std::uint32_t page, const Bounds* bounds);
  /// Checks the moments that are stated for a node against those that it states for its children.
  void add_node(const octree::Node& node, std::uint32_t page, const Bounds& bounds);
  /// Adds a subtree of another page, which Bounds::subtree then names.
  std::uint32_t add_subtree(std::uint32_t page) { return keys_.add_subtree(page); }
  /// Adds the box that is stated for the root of the tree.
  void add_root(const octree::FloatBox& box) { root_ = box; }
  /// Checks the octcodes of the pages, once all blocks were added.
  void check_keys(std::span<const storage::PageEntry> entries);
  /// Checks the header and the root's box.
  ///
  /// complete  whether all blocks were added; otherwise nothing is checked
  void finish(bool complete);
  /// Checks that the caps close the surface, each is there once, and none is out of the box.
  ///
  /// complete  whether all blocks of both were added; otherwise nothing is checked
  void finish_caps(bool complete, const GeometryCheck& surface);

 private:
  void add_triangle(const octree::Triangle& triangle, std::uint64_t index, std::uint32_t page);
  void add_codes(const octree::BlockView& block, const Bounds* bounds);
  void check_root();
  void add_ids(const octree::BlockView& block, std::uint32_t page);
  void check_vertices(const octree::BlockView& block, std::uint32_t page, const Bounds& bounds);
  bool insert(std::uint64_t id);
  bool is_box(double lower, double upper, int axis) const;
  void report(IssueCode code, std::uint32_t page, std::string message);

  const storage::ModelRecord& model_;
  IssueList& issues_;
  const bool of_caps_;
  // One bit per triangle index seen, in pieces, so that memory does not depend on unchecked counts.
  std::unordered_map<std::uint64_t, std::array<std::uint64_t, 8>> seen_;
  std::uint64_t min_id_ = storage::kNoTriangle;
  double area_ = 0;  // of the caps
  bool sample_seen_ = false;
  std::optional<octree::FloatBox> root_;
  PageKeys keys_;
  EdgeCheck edges_;
  octree::AreaSums areas_;
  octree::Point lower_, upper_;                // of all vertices, model frame
  octree::Point region_lower_, region_upper_;  // the part of the region within the model's box
  bool has_walls_ = false;                     // whether the region has walls
};

}  // namespace planetree::tools
