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
///   from other triangles than those that the builder used. With walls they are counted along the
///   segment to the region's first corner, whose winding number the header states.
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
  std::vector<octree::Triangle> triangles_touching(const octree::GridCell& cell);
  void report(IssueCode code, std::uint32_t page, std::string message);

  std::unique_ptr<query::ModelState> model_;
  cache::Reader reader_;
  IssueList& issues_;
  octree::ClippedGrid grid_;
  std::unordered_map<std::uint64_t, std::optional<std::int64_t>> counted_;  ///< by corner_key()
};

}  // namespace planetree::tools
