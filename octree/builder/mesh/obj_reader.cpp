#include "octree/builder/mesh/obj_reader.h"

#include <cinttypes>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "octree/builder/mesh/obj_notes.h"
#include "octree/builder/mesh/stream/face_vertex_join.h"
#include "octree/builder/mesh/stream/fan_emitter.h"
#include "octree/builder/mesh/stream/indexed_face.h"
#include "octree/builder/mesh/stream/mesh_lines.h"
#include "octree/builder/mesh/stream/mesh_text.h"
#include "octree/builder/mesh/stream/text_vertices.h"

namespace planetree::octree {

namespace {

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

/// Whether a keyword is that of a face. Old files have "fo" for it.
bool is_face(std::string_view keyword) { return keyword == "f" || keyword == "fo"; }

/// Reads an OBJ in two passes, since an f may name a later v.
class Obj {
 public:
  Obj(const MeshFile& file, TriangleSink& sink, MeshScratch& scratch)
      : file_(file),
        scratch_(scratch),
        emitter_(sink, RecordKind::kLine, 2 * file.size_bytes()),
        vertices_(file, false, scratch) {}

  Result<MeshSummary> read() {
    const Result<TextPosition> begin = text_begin(file_);
    if (!begin) return begin.error();
    if (Result<void> read = read_vertices(*begin); !read) return read.error();
    FaceVertexJoin join(vertices_, 1, scratch_, true, emitter_);
    const auto read = join.deliver(
        {*begin, 0, 0}, file_.size_bytes(),
        [this](const FacePosition& from, const auto& take) { return each_face(from, take); });
    if (!read) return read.error();
    Result<MeshSummary> summary = emitter_.finish(false);
    if (summary) summary->notes = notes_.texts();
    return summary || faces_read_ ? summary : no_faces(summary.error());
  }

 private:
  [[nodiscard]] ObjStatements statements_from(TextPosition begin) const {
    return {file_, begin, static_cast<std::size_t>(scratch_.window_bytes())};
  }

  Result<void> read_vertices(TextPosition begin) {
    ObjStatements statements = statements_from(begin);
    while (statements.next()) {
      std::string_view rest = statements.text();
      const std::string_view keyword = take_word(rest);
      if (keyword == "v") {
        if (Result<void> taken = take_vertex(statements, rest); !taken) return taken;
      } else if (!is_face(keyword)) {
        notes_.add(statements.position().line, keyword);
      }
      if (const auto told = emitter_.advance(statements.end_offset()); !told) return told.error();
    }
    if (statements.failure()) return *statements.failure();
    emitter_.set_vertex_count(vertices_.count());
    return vertices_.finish();
  }

  /// Calls take(face) for each face, as FaceVertexJoin::deliver() requires.
  template <class Take>
  Result<FacePosition> each_face(const FacePosition& from, const Take& take) {
    ObjStatements statements = statements_from(from.position);
    std::int64_t vertices_before = from.vertices_before;
    while (statements.next()) {
      std::string_view rest = statements.text();
      const std::string_view keyword = take_word(rest);
      if (keyword == "v") ++vertices_before;
      if (is_face(keyword)) {
        faces_read_ = true;
        if (Result<void> read = read_face(statements, rest); !read) return read.error();
        const Result<bool> taken =
            take(IndexedFace(statements.position().line, numbers_, vertices_before));
        if (!taken) return taken.error();
        if (!*taken) return FacePosition{statements.position(), 0, vertices_before};
      }
      if (const auto told = emitter_.advance(file_.size_bytes() + statements.end_offset()); !told)
        return told.error();
    }
    if (statements.failure()) return *statements.failure();
    return FacePosition{{statements.end_offset(), 0}, 0, vertices_before};
  }

  /// Reads the three coordinates. A colour or a weight behind them is ignored.
  Result<void> take_vertex(const ObjStatements& statements, std::string_view rest) {
    Vec3 position;
    for (double* const value : {&position.x, &position.y, &position.z}) {
      const std::string_view word = take_word(rest);
      if (word.empty()) return error(statements, "a vertex of fewer than three numbers");
      if (!parse_real(word, *value)) {
        return error(statements, "'" + printable(word) + "' is not a number");
      }
    }
    return vertices_.add(position);
  }

  /// Reads the statement of a face into numbers_.
  Result<void> read_face(const ObjStatements& statements, std::string_view rest) {
    numbers_.clear();
    for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) {
      if (word.front() == '#') break;
      std::string_view behind = word;
      std::int64_t number = 0;
      if (!take_integer(behind, number) || !(behind.empty() || behind.front() == '/')) {
        return error(statements, "'" + printable(word) + "' is not a corner of a face");
      }
      numbers_.push_back(number);
    }
    return {};
  }

  /// The error of a mesh without faces, with the statements that may have been meant as such.
  [[nodiscard]] Error no_faces(const Error& error) const {
    const std::vector<std::string> notes = notes_.texts();
    if (notes.empty()) return error;
    return make_error(error.code, Error::kNowhere, Error::kNowhere,
                      "no triangle: the mesh has no faces, but %s", notes.front().c_str());
  }

  [[nodiscard]] static Error error(const ObjStatements& statements, const std::string& cause) {
    return make_error(ErrorCode::kBadInput, Error::kNowhere, statements.position().offset,
                      "line %" PRIu64 ": %s; copy or export the OBJ again",
                      statements.position().line, cause.c_str());
  }

  const MeshFile& file_;
  MeshScratch& scratch_;
  FanEmitter emitter_;
  TextVertices vertices_;
  std::vector<std::int64_t> numbers_;  ///< vertices of the f being read, as written
  ObjNotes notes_;
  bool faces_read_ = false;
};

}  // namespace

Result<MeshSummary> read_obj(const MeshFile& file, TriangleSink& sink, MeshScratch& scratch) {
  return with_note_of_padding(file, Obj(file, sink, scratch).read());
}

}  // namespace planetree::octree
