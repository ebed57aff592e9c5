#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "octree/builder/mesh/stream/mesh_file.h"
#include "octree/builder/mesh/stream/mesh_lines.h"
#include "octree/builder/mesh/stream/mesh_text.h"
#include "planetree/error.h"

namespace planetree::octree {

/// Steps through the statements of an OBJ. A line that ends in a backslash is joined with the next.
/// A comment is never joined: a Windows path may end it.
class ObjStatements {
 public:
  ObjStatements(const MeshFile& file, TextPosition begin, std::size_t window_bytes)
      : lines_(file, begin, LineComment::kNone, window_bytes) {}

  bool next() {
    if (!lines_.next()) return false;
    position_ = lines_.position();
    text_ = lines_.line();
    if (!without_backslash(text_)) return true;
    joined_.assign(text_);
    bool continues = true;
    while (continues && lines_.next()) {
      std::string_view part = lines_.line();
      continues = without_backslash(part);
      joined_ += ' ';
      joined_ += part;
    }
    text_ = joined_;
    return !lines_.failure();
  }

  [[nodiscard]] std::string_view text() const { return text_; }
  [[nodiscard]] TextPosition position() const { return position_; }
  /// The error that ended the statements; empty at the end of the file.
  [[nodiscard]] const std::optional<Error>& failure() const { return lines_.failure(); }
  [[nodiscard]] std::uint64_t end_offset() const { return lines_.after().offset; }

 private:
  /// Removes the backslash from a line that goes on; false if the line does not go on.
  static bool without_backslash(std::string_view& line) {
    const std::size_t last = line.find_last_not_of(" \t\r");
    if (last == std::string_view::npos || line[last] != '\\') return false;
    if (line[line.find_first_not_of(" \t")] == '#') return false;
    line = line.substr(0, last);
    return true;
  }

  MeshLines lines_;
  TextPosition position_;
  std::string_view text_;
  std::string joined_;
};

}  // namespace planetree::octree
