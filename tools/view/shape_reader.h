#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "octree/geometry/child_bounds.h"
#include "octree/page/frame.h"
#include "planetree/error.h"
#include "tools/check/file_parts.h"
#include "tools/view/shape_place.h"
#include "tools/view/view_request.h"

namespace planetree::tools {

/// A part of the surface that is shown by the disc of its bounds. Lengths are in the frame of its
/// file's shape; see ShapeFrame::of.
struct ShapePiece {
  octree::FloatBox box;
  octree::Disc disc;
  std::uint32_t link = 0;      ///< to the record with what is within
  std::uint32_t page = 0;      ///< that the link leads to
  std::uint16_t depth = 0;     ///< nodes on the way from the root
  std::uint32_t instance = 0;  ///< that it belongs to: index of its place
  float weight = 0;            ///< how large it looks; pieces of large weight are divided first
};

/// A triangle of a block, as float.
struct ShapeTriangle {
  std::array<float, 9> corners;
  std::uint32_t page;
  std::uint16_t depth;
  std::uint32_t instance;
};

/// A shape: every part of the surface is in one piece or one triangle.
struct ViewShape {
  std::vector<ShapePiece> pieces;
  std::vector<ShapeTriangle> triangles;
  std::uint32_t pages_read = 0;  ///< pages read for it so far, repeatedly read ones counted again
  bool is_complete = false;      ///< nothing within the limit of the view can make it finer

  std::size_t size() const { return pieces.size() + triangles.size(); }
};

/// A file that is shown in a place.
struct ShapeInstance {
  std::size_t file = 0;  ///< index of the file
  ShapePlace place;
};

/// Makes shapes of files in their places: starts with the roots of the trees and divides the pieces
/// that look largest, round by round, each round all pieces of a page together, whichever instances
/// they belong to. It reads files page by page beside the models' memory, so that looking at the
/// surface does not change which pages are resident.
///
/// memory   one decoded page for each file, and the shape
/// threads  one at a time
class ShapeReader {
 public:
  /// Reads the header and the directory of a file that ShapeReader takes.
  ///
  /// errors  those of FileParts::open(); kDamaged: its header cannot be read
  static Result<FileParts> open_file(const std::filesystem::path& path);
  /// A reader of one file in its own frame.
  ///
  /// errors  those of open_file()
  static Result<ShapeReader> open(const std::filesystem::path& path);
  /// A reader of files in places. A shape has at least the parts that the roots divide into.
  ShapeReader(std::vector<FileParts> files, std::vector<ShapeInstance> instances);

  /// Reads pages for at most about `most`, and returns the shape of a view as far as it is then.
  /// Call it again with the same view to continue.
  ///
  /// errors  kDamaged: a page cannot be read
  Result<const ViewShape*> read(const ShapeView& view, std::chrono::milliseconds most);

  /// The bytes of the shape of a view as far as it is after a quarter of a second.
  ///
  /// errors  as read()
  Result<std::string> read_bytes(const ShapeView& view);

  /// Header and directory of a file.
  const FileParts& parts(std::size_t file = 0) const { return files_[file]; }

 private:
  using Time = std::chrono::steady_clock::time_point;
  void start(const ShapeView& view);
  std::vector<ShapePiece> take_due();
  Result<void> divide_all(std::vector<ShapePiece> due, Time end);
  Result<void> divide_in_page(std::span<const ShapePiece> due);
  std::size_t file_of(const ShapePiece& piece) const { return instances_[piece.instance].file; }
  bool has_record(const ShapePiece& piece) const;
  void add_children(const ShapePiece& piece, std::vector<ShapePiece>& inner);
  void add_triangles(const ShapePiece& piece);
  float weight_of(const ShapePiece& piece) const;
  bool may_divide(const ShapePiece& piece) const;

  std::vector<FileParts> files_;
  std::vector<ShapeInstance> instances_;
  ShapeView view_;                // without discs: none yet
  std::vector<ShapeView> views_;  // the same in the frame of each instance's file
  ViewShape shape_;
  std::size_t count_ = 0;  // size of the shape, with the pieces that are being divided
  float threshold_ = 0;    // pieces of greater weight are divided in this round
  bool is_full_ = false;
};

/// The bytes of a shape, as tools/view/README.md describes them.
std::string shape_bytes(const ViewShape& shape);

}  // namespace planetree::tools
