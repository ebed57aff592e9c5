#include "octree/build/obj_reader.h"

#include <cinttypes>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "octree/build/mesh_delivery.h"
#include "octree/build/mesh_text.h"

namespace planetree::octree {

namespace {

/// Steps through the statements of an OBJ: lines, joined where a line ends in
/// a backslash. A comment is never joined: a Windows path may end it.
class ObjStatements {
 public:
  explicit ObjStatements(std::string_view text) : lines_(text, text_begin(text)) {}

  bool next() {
    if (!lines_.next()) return false;
    place_ = lines_.place();
    text_ = lines_.line();
    if (!without_backslash(text_)) return true;
    joined_.assign(text_);
    bool goes_on = true;
    while (goes_on && lines_.next()) {
      std::string_view part = lines_.line();
      goes_on = without_backslash(part);
      joined_ += ' ';
      joined_ += part;
    }
    text_ = joined_;
    return true;
  }

  [[nodiscard]] std::string_view text() const { return text_; }
  [[nodiscard]] TextPlace place() const { return place_; }
  [[nodiscard]] std::uint64_t end_offset() const { return lines_.after().offset; }

 private:
  /// Cuts the backslash off a line that goes on; false if it does not.
  static bool without_backslash(std::string_view& line) {
    const std::size_t last = line.find_last_not_of(" \t\r");
    if (last == std::string_view::npos || line[last] != '\\') return false;
    if (line[line.find_first_not_of(" \t")] == '#') return false;
    line = line.substr(0, last);
    return true;
  }

  LineScanner lines_;
  TextPlace place_;
  std::string_view text_;
  std::string joined_;
};

/// Reads in two passes, since an f may name a later v.
class Obj {
 public:
  Obj(MeshFile& file, TriangleSink& sink)
      : file_(file), delivery_(sink, RecordKind::kLine, 2 * file.size_bytes()) {}

  Result<MeshSummary> read() {
    if (Result<void> read = read_vertices(); !read) return read.error();
    if (Result<void> read = read_faces(); !read) return read.error();
    return delivery_.finish(false);
  }

 private:
  Result<void> read_vertices() {
    ObjStatements statements(file_.text());
    while (statements.next()) {
      file_.touch(statements.place().offset);
      std::string_view rest = statements.text();
      if (take_word(rest) == "v") {
        if (Result<void> taken = take_vertex(statements, rest); !taken) return taken;
      }
      delivery_.advance(statements.end_offset());
    }
    delivery_.set_vertex_count(coordinates_.size() / 3);
    return {};
  }

  Result<void> read_faces() {
    ObjStatements statements(file_.text());
    std::int64_t vertices_so_far = 0;
    while (statements.next()) {
      file_.touch(statements.place().offset);
      std::string_view rest = statements.text();
      const std::string_view keyword = take_word(rest);
      if (keyword == "v") ++vertices_so_far;
      if (keyword == "f") {
        if (Result<void> taken = take_face(statements, rest, vertices_so_far); !taken) return taken;
      }
      delivery_.advance(file_.size_bytes() + statements.end_offset());
    }
    return {};
  }

  /// Colours or a weight may follow the three coordinates; they are not read.
  Result<void> take_vertex(const ObjStatements& statements, std::string_view rest) {
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view word = take_word(rest);
      if (word.empty()) return error(statements, "a vertex of fewer than three numbers");
      double value = 0;
      if (!parse_real(word, value)) {
        return error(statements, "'" + printable(word) + "' is not a number");
      }
      coordinates_.push_back(value);
    }
    return {};
  }

  Result<void> take_face(const ObjStatements& statements, std::string_view rest,
                         std::int64_t vertices_so_far) {
    corners_.clear();
    for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) {
      if (word.front() == '#') break;
      std::string_view behind = word;
      std::int64_t number = 0;
      if (!take_integer(behind, number) || !(behind.empty() || behind.front() == '/')) {
        return error(statements, "'" + printable(word) + "' is not a corner of a face");
      }
      corners_.push_back(number);
    }
    return delivery_.polygon(
        statements.place().line, corners_.size(),
        [this, vertices_so_far](std::uint64_t k) { return corner(corners_[k], vertices_so_far); });
  }

  [[nodiscard]] MeshCorner corner(std::int64_t number, std::int64_t vertices_so_far) const {
    // Number 0 is none: it becomes the index -1.
    const std::int64_t index = number < 0 ? number + vertices_so_far : number - 1;
    const auto vertex_count = static_cast<std::int64_t>(coordinates_.size() / 3);
    if (index < 0 || index >= vertex_count) return {{}, number, false};
    const auto at = 3 * static_cast<std::size_t>(index);
    return {{coordinates_[at], coordinates_[at + 1], coordinates_[at + 2]}, number, true};
  }

  [[nodiscard]] static Error error(const ObjStatements& statements, const std::string& cause) {
    return make_error(ErrorCode::kBadInput, Error::kNowhere, statements.place().offset,
                      "line %" PRIu64 ": %s; copy or export the OBJ again", statements.place().line,
                      cause.c_str());
  }

  MeshFile& file_;
  MeshDelivery delivery_;
  std::vector<double> coordinates_;    ///< x, y, z of each v
  std::vector<std::int64_t> corners_;  ///< vertex numbers of the f being read, as written
};

}  // namespace

Result<MeshSummary> read_obj(MeshFile& file, TriangleSink& sink) { return Obj(file, sink).read(); }

}  // namespace planetree::octree
