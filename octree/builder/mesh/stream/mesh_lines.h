#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "octree/builder/mesh/stream/mesh_file.h"
#include "octree/builder/mesh/stream/mesh_text.h"
#include "octree/builder/mesh/stream/mesh_window.h"
#include "planetree/error.h"

namespace planetree::octree {

/// Steps through the lines of a mesh file, as LineScanner does through those of a text. Only a
/// window of the file is in memory.
class MeshLines {
 public:
  /// Maximum length of a line, which is in memory as a whole. A longer line is refused.
  static constexpr std::uint64_t kMaxLineBytes = std::uint64_t{32} << 20;

  /// file  must outlive this.
  MeshLines(const MeshFile& file, TextPosition start, LineComment comment = LineComment::kNone,
            std::size_t window_bytes = MeshWindow::kWindowBytes)
      : size_bytes_(file.size_bytes()),
        comment_(comment),
        window_(file, window_bytes),
        window_bytes_(std::max<std::uint64_t>(window_bytes, MeshWindow::kRecordBytes)),
        base_(start.offset),
        lines_({}, {0, start.line}, LineEnd::kAny, comment) {}

  /// Steps to the next line. False at the end of the file, or if the line cannot be read: see
  /// failure().
  bool next() {
    while (!lines_.next())
      if (!refill()) return false;
    return true;
  }
  /// Steps to the next line that has a word; false as next().
  bool next_filled() {
    while (!lines_.next_filled())
      if (!refill()) return false;
    return true;
  }

  /// As those of LineScanner. The characters of line() are valid until the next step.
  [[nodiscard]] std::string_view line() const { return lines_.line(); }
  [[nodiscard]] TextPosition position() const { return in_file(lines_.position()); }
  [[nodiscard]] TextPosition after() const { return in_file(lines_.after()); }

  [[nodiscard]] const std::optional<Error>& failure() const { return failure_; }

 private:
  [[nodiscard]] TextPosition in_file(const TextPosition& position) const {
    return {base_ + position.offset, position.line};
  }
  bool refill();
  bool fail(const Error& error) {
    failure_ = error;
    return false;
  }

  std::uint64_t size_bytes_;
  LineComment comment_;
  MeshWindow window_;
  std::uint64_t window_bytes_;
  std::uint64_t base_;  ///< offset of the text of lines_ in the file
  LineScanner lines_;   ///< over whole lines
  std::optional<Error> failure_;
};

/// Position where the text of a file begins; see text_begin() in mesh_text.h.
Result<TextPosition> text_begin(const MeshFile& file);

}  // namespace planetree::octree
