#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "octree/geometry/child_bounds.h"
#include "octree/page/frame.h"
#include "planetree/error.h"
#include "tools/check/file_parts.h"
#include "tools/view/view_request.h"

namespace planetree::tools {

/// A part of the surface that is shown by the disc of its bounds. Lengths are in the model frame,
/// relative to the model's centre.
struct ShapePiece {
  octree::FloatBox box;
  octree::Disc disc;
  std::uint32_t link = 0;   ///< to the record with what is within
  std::uint32_t page = 0;   ///< that the link leads to
  std::uint16_t depth = 0;  ///< nodes on the way from the root
  float weight = 0;         ///< how large it looks; pieces of large weight are divided first
};

/// A triangle of a block, as float.
struct ShapeTriangle {
  std::array<float, 9> corners;
  std::uint32_t page;
  std::uint16_t depth;
};

/// A shape: every part of the surface is in one piece or one triangle.
struct ViewShape {
  std::vector<ShapePiece> pieces;
  std::vector<ShapeTriangle> triangles;
  std::uint32_t pages_read = 0;  ///< pages read for it so far, repeatedly read ones counted again
  bool is_complete = false;      ///< nothing within the limit of the view can make it finer

  std::size_t size() const { return pieces.size() + triangles.size(); }
};

/// Makes shapes of a file: starts with the root of the tree and divides the pieces that look
/// largest, round by round, each round all pieces of a page together. It reads the file page by
/// page beside the model's memory, so that looking at the surface does not change which pages are
/// resident.
///
/// memory   one decoded page, and the shape
/// threads  one at a time
class ShapeReader {
 public:
  /// errors  those of FileParts::open(); kDamaged: its header or root cannot be read
  static Result<ShapeReader> open(const std::filesystem::path& path);

  /// Reads pages for at most about `most`, and returns the shape of a view as far as it is then.
  /// Call it again with the same view to continue.
  ///
  /// errors  kDamaged: a page cannot be read
  Result<const ViewShape*> read(const ShapeView& view, std::chrono::milliseconds most);

  /// Header and page table of the file.
  const FileParts& parts() const { return parts_; }

 private:
  explicit ShapeReader(FileParts parts)
      : parts_(std::move(parts)), links_(parts_.header()->page_bytes) {}
  using Time = std::chrono::steady_clock::time_point;
  void start(const ShapeView& view);
  std::vector<ShapePiece> take_due();
  Result<void> divide_all(std::vector<ShapePiece> due, Time end);
  Result<void> divide_in_page(std::span<const ShapePiece> due);
  bool has_record(std::uint32_t link) const;
  void add_children(const ShapePiece& piece, std::vector<ShapePiece>& inner);
  void add_triangles(const ShapePiece& piece);
  float weight_of(const ShapePiece& piece) const;
  bool may_divide(const ShapePiece& piece) const;

  FileParts parts_;
  octree::LinkFormat links_;
  ShapeView view_;  // without discs: none yet
  ViewShape shape_;
  std::size_t count_ = 0;  // size of the shape, with the pieces that are being divided
  float threshold_ = 0;    // pieces of greater weight are divided in this round
  bool is_full_ = false;
};

/// The bytes of a shape, as tools/view/README.md describes them.
std::string shape_bytes(const ViewShape& shape);

}  // namespace planetree::tools
