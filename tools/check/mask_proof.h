#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "octree/geometry/cell_grid.h"
#include "octree/page/frame.h"
#include "planetree/error.h"
#include "tools/check/file_check.h"
#include "tools/check/mask_walk.h"
#include "tools/check/model_reader.h"

namespace planetree::tools {

/// Checks the statements of a mask against the triangles:
///
/// - Winding numbers at corners and in cells of one colour are counted again along exit segments,
///   from other triangles than those that the builder used.
/// - Triangles touch grey cells only.
/// - A listed cell lists all blocks that touch it, and the surface in it is within its slab.
/// - The planes of a special cell describe which part of it is inside.
///
/// memory  that of a ModelReader, and the corners of one page
class MaskProof {
 public:
  /// Opens the file as a model. `issues` must outlive this.
  ///
  /// errors  as ModelReader::open
  static Result<std::unique_ptr<MaskProof>> open(const std::filesystem::path& path,
                                                 IssueList& issues);

  /// Checks the header's winding number at the region's first corner, along a segment to the
  /// outside. Returns whether it is right, or cannot be checked because all sides are walls.
  bool check_region();
  /// Checks one grey cell.
  void check_cell(const GreyCell& grey);
  /// Forgets the corners counted so far. Cells that share corners are mostly in one page.
  void end_page() { counted_.clear(); }

 private:
  MaskProof(ModelReader opened, IssueList& issues);

  void check_octants(const GreyCell& grey);
  void check_colour(std::uint32_t page, const octree::GridCell& cell, int colour);
  void check_corners(const GreyCell& grey, const octree::MaskCorners& corners);
  void check_list(const GreyCell& grey);
  bool is_within_slab(const GreyCell& grey, const octree::BlockView& block) const;
  void check_special(const GreyCell& grey);
  /// The winding number at a corner. Empty if pages cannot be read.
  std::optional<std::int64_t> winding(const octree::GridCell& cell, unsigned corner);
  std::optional<std::int64_t> count_winding(const octree::Point& point);
  /// The same in the file of a region: along a segment that is beyond no wall, to the outside or,
  /// if all sides are walls, to the region's first corner.
  std::optional<std::int64_t> count_along_walls(const octree::Point& point);
  /// Those of the surface; caps_touching() returns those of the caps.
  std::vector<octree::Triangle> triangles_touching(const octree::GridCell& cell);
  std::vector<octree::Triangle> caps_touching(const octree::GridCell& cell);
  std::vector<octree::Triangle> triangles_touching(const octree::GridCell& cell,
                                                   const octree::TreeInfo& tree);
  void report(IssueCode code, std::uint32_t page, std::string message);

  std::unique_ptr<query::ModelState> model_;
  cache::Reader reader_;
  IssueList& issues_;
  octree::ClippedGrid grid_;
  std::unordered_map<std::uint64_t, std::optional<std::int64_t>> counted_;  ///< by corner_key()
};

}  // namespace planetree::tools
