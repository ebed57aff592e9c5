#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "octree/builder/mesh/stream/mesh_file.h"
#include "octree/builder/mesh/stream/mesh_text.h"
#include "octree/builder/mesh/stream/mesh_window.h"
#include "octree/builder/mesh/stream/triangle_sink.h"
#include "planetree/error.h"

namespace planetree::octree {

/// Length of the text of a file: without zero bytes and Ctrl-Z at its end, which copying and old
/// systems leave there.
Result<std::uint64_t> text_bytes(const MeshFile& file);
/// Adds a note to the summary of a text if there are zero bytes at its end.
Result<MeshSummary> with_note_of_padding(const MeshFile& file, Result<MeshSummary> summary);

/// Whether lines that are longer than a window are divided between two words.
enum class LongLines : std::uint8_t { kWhole, kDivided };

/// Steps through the lines of a mesh file, as LineScanner does through those of a text. Only a
/// window of the file is in memory. Zero bytes and Ctrl-Z at the end of the file are no text.
class MeshLines {
 public:
  /// Maximum length of a line, or of a word in a divided line, which is in memory as a whole. A
  /// longer one is refused.
  static constexpr std::uint64_t kMaxLineBytes = std::uint64_t{32} << 20;

  /// file  must outlive this.
  MeshLines(const MeshFile& file, TextPosition start, LineComment comment = LineComment::kNone,
            std::size_t window_bytes = MeshWindow::kWindowBytes,
            LongLines long_lines = LongLines::kWhole)
      : size_bytes_(file.size_bytes()),
        comment_(comment),
        long_lines_(long_lines),
        window_(file, window_bytes),
        window_bytes_(std::max<std::uint64_t>(window_bytes, MeshWindow::kRecordBytes)),
        base_(start.offset),
        lines_({}, {0, start.line}, LineEnd::kAny, comment) {
    const Result<std::uint64_t> size = text_bytes(file);
    if (size) size_bytes_ = std::max(*size, start.offset);
    if (!size) failure_ = size.error();
  }

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
  /// Whether the current line goes on in the next step.
  [[nodiscard]] bool is_divided() const { return part_bytes_ > 0; }
  /// Whether the current line began in an earlier step.
  [[nodiscard]] bool continues() const { return continues_ && lines_.position().offset == 0; }

  /// As those of LineScanner. The characters of line() are valid until the next step.
  [[nodiscard]] std::string_view line() const { return lines_.line(); }
  [[nodiscard]] TextPosition position() const { return in_file(lines_.position()); }
  [[nodiscard]] TextPosition after() const {
    TextPosition position = in_file(lines_.after());
    if (is_divided() && lines_.after().offset > 0) --position.line;
    return position;
  }

  [[nodiscard]] const std::optional<Error>& failure() const { return failure_; }

 private:
  [[nodiscard]] TextPosition in_file(const TextPosition& position) const {
    return {base_ + position.offset, position.line, 0};
  }
  void set_text(std::string_view text, TextPosition begin);
  bool refill();
  bool fail(const Error& error) {
    failure_ = error;
    return false;
  }

  std::uint64_t size_bytes_;
  LineComment comment_;
  LongLines long_lines_;
  MeshWindow window_;
  std::uint64_t window_bytes_;
  std::uint64_t base_;          ///< offset of the text of lines_ in the file
  LineScanner lines_;           ///< over whole lines, or a part of one
  std::size_t part_bytes_ = 0;  ///< length of the text if it is a part of a line
  bool continues_ = false;      ///< the text begins within a line
  std::optional<Error> failure_;
};

/// Position where the text of a file begins; see text_begin() in mesh_text.h.
Result<TextPosition> text_begin(const MeshFile& file);

}  // namespace planetree::octree
