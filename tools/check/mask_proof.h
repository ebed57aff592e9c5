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

#include "octree/geometry/clipped_grid.h"
#include "octree/page/block_view.h"
#include "planetree/error.h"
#include "tools/check/file_check.h"
#include "tools/check/mask_walk.h"
#include "tools/check/model_reader.h"

namespace planetree::tools {

/// Holds what a mask says against the triangles: winding numbers at corners and
/// in cells of one colour by the way straight out of the model's box, so by
/// other triangles than those they were found with, or, of a region, by the way
/// to its least corner, whose number is taken from the header; and that only
/// grey cells are touched, and only by blocks that they list, if they do, and between their slabs'
/// planes.
///
/// memory  that of a ModelReader, and the corners of one page
class MaskProof {
 public:
  static Result<std::unique_ptr<MaskProof>> open(const std::filesystem::path& path,
                                                 IssueList& issues);

  void look_at(const GreyCell& grey);
  /// Forgets the corners counted so far: neighbours are mostly in one page.
  void end_page() { counted_.clear(); }

 private:
  MaskProof(ModelReader opened, IssueList& issues);

  void check_octants(const GreyCell& grey);
  void check_colour(std::uint32_t page, const octree::GridCell& cell, int colour);
  void check_corners(const GreyCell& grey, const octree::MaskCorners& corners);
  void check_list(const GreyCell& grey);
  bool keeps_to_slab(const GreyCell& grey, const octree::BlockView& block) const;
  void check_special(const GreyCell& grey);
  /// Nothing if pages are missing.
  std::optional<std::int64_t> winding(const octree::GridCell& cell, unsigned corner);
  std::optional<std::int64_t> recount(const octree::Point& point);
  std::vector<octree::Triangle> touching(const octree::GridCell& cell);
  void report(IssueCode code, std::uint32_t page, std::string message);

  std::unique_ptr<query::ModelState> model_;
  cache::Reader reader_;
  IssueList& issues_;
  octree::ClippedGrid grid_;
  std::unordered_map<std::uint64_t, std::optional<std::int64_t>> counted_;  ///< by corner
};

}  // namespace planetree::tools
