#include "octree/builder/mesh/obj/obj_reader.h"

#include <algorithm>
#include <cinttypes>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "octree/builder/mesh/obj/obj_notes.h"
#include "octree/builder/mesh/obj/obj_statements.h"
#include "octree/builder/mesh/stream/attribute_names.h"
#include "octree/builder/mesh/stream/face_vertex_join.h"
#include "octree/builder/mesh/stream/fan_emitter.h"
#include "octree/builder/mesh/stream/indexed_face.h"
#include "octree/builder/mesh/stream/mesh_lines.h"
#include "octree/builder/mesh/stream/mesh_note.h"
#include "octree/builder/mesh/stream/mesh_text.h"
#include "octree/builder/mesh/stream/text_records.h"
#include "octree/builder/mesh/stream/text_vertices.h"

namespace planetree::octree {

namespace {

/// Whether a keyword is that of a face. Old files have "fo" for it.
bool is_face(std::string_view keyword) { return keyword == "f" || keyword == "fo"; }

/// Reads an OBJ in two passes, since an f may name a later v.
class Obj {
 public:
  Obj(const MeshFile& file, TriangleSink& sink, MeshScratch& scratch, std::uint32_t keep)
      : file_(file),
        scratch_(scratch),
        emitter_(sink, RecordKind::kLine, 2 * file.size_bytes()),
        keeps_colors_((keep & kKeepColor) != 0),
        keeps_uvs_((keep & kKeepUv) != 0),
        vertices_(file, false, keep & kKeepColor, held_bytes(), scratch) {
    emitter_.set_keep(keep);
    if (keeps_uvs_) uvs_.emplace(file, sizeof(TextureCoordinate), held_bytes(), scratch);
  }

  Result<MeshSummary> read() {
    const Result<TextPosition> begin = text_begin(file_);
    if (!begin) return begin.error();
    if (Result<void> read = read_vertices(*begin); !read) return read.error();
    FaceVertexJoin join(vertices_, 1, scratch_, true, emitter_, uvs_ ? &*uvs_ : nullptr);
    const auto read = join.deliver(
        {*begin, 0, 0}, file_.size_bytes(),
        [this](const FacePosition& from, const auto& take) { return each_face(from, take); });
    if (!read) return read.error();
    Result<MeshSummary> summary = emitter_.finish(false);
    if (summary) summary->notes = notes();
    return summary || faces_read_ ? summary : no_faces(summary.error());
  }

 private:
  /// Memory for the vertices, and as much for texture vertices.
  [[nodiscard]] std::uint64_t held_bytes() const {
    return MeshScratch::text_bytes(scratch_.memory_bytes()) / (keeps_uvs_ ? 2 : 1);
  }

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
      } else if (keeps_uvs_ && keyword == "vt") {
        if (Result<void> taken = take_uv(statements, rest); !taken) return taken;
      } else if (!is_face(keyword)) {
        notes_.add(statements.position().line, keyword);
      }
      if (const auto told = emitter_.advance(statements.end_offset()); !told) return told.error();
    }
    if (statements.failure()) return *statements.failure();
    emitter_.set_vertex_count(vertices_.count());
    if (Result<void> finished = vertices_.finish(); !finished || !keeps_uvs_) return finished;
    if (uvs_->count() == 0) return missing_attribute(kKeepUv, "no statement 'vt'");
    return uvs_->finish();
  }

  /// Calls take(face) for each face, as FaceVertexJoin::deliver() requires.
  template <class Take>
  Result<FacePosition> each_face(const FacePosition& from, const Take& take) {
    ObjStatements statements = statements_from(from.position);
    std::int64_t vertices_before = from.vertices_before, uvs_before = from.uvs_before;
    while (statements.next()) {
      std::string_view rest = statements.text();
      const std::string_view keyword = take_word(rest);
      if (keyword == "v") ++vertices_before;
      if (keyword == "vt") ++uvs_before;
      if (is_face(keyword)) {
        faces_read_ = true;
        if (Result<void> read = read_face(statements, rest, uvs_before); !read) return read.error();
        const FaceAttributes attributes{.color = {}, .uvs = {}, .uv_vertices = uv_vertices_};
        const Result<bool> taken =
            take(IndexedFace(statements.position().line, numbers_, vertices_before, &attributes));
        if (!taken) return taken.error();
        if (!*taken) return FacePosition{statements.position(), 0, vertices_before, uvs_before};
      }
      if (const auto told = emitter_.advance(file_.size_bytes() + statements.end_offset()); !told)
        return told.error();
    }
    if (statements.failure()) return *statements.failure();
    return FacePosition{{statements.end_offset(), 0}, 0, vertices_before, uvs_before};
  }

  /// Reads the three coordinates, and a colour behind them if it is kept.
  Result<void> take_vertex(const ObjStatements& statements, std::string_view rest) {
    Vec3 position;
    for (double* const value : {&position.x, &position.y, &position.z}) {
      const std::string_view word = take_word(rest);
      if (word.empty()) return error(statements, "a vertex of fewer than three numbers");
      if (!parse_real(word, *value)) {
        return error(statements, "'" + printable(word) + "' is not a number");
      }
    }
    if (!keeps_colors_) return vertices_.add(position);
    CornerAttributes attributes;
    if (!take_color(rest, attributes.color))
      return make_error(ErrorCode::kBadInput, Error::kNowhere, statements.position().offset,
                        "line %" PRIu64
                        ": a vertex has no colour: it is not 'v x y z r g b'; build the mesh "
                        "without --keep color",
                        statements.position().line);
    return vertices_.add(position, attributes);
  }

  /// Reads exactly three channels, as shares of 1.
  static bool take_color(std::string_view rest, Color& color) {
    for (std::uint8_t* const channel : {&color.red, &color.green, &color.blue}) {
      double share = 0;
      if (!parse_real(take_word(rest), share)) return false;
      *channel = to_channel(share * 255);
    }
    const std::string_view behind = take_word(rest);
    return behind.empty() || behind.front() == '#';
  }

  /// Reads a texture vertex. A third number is ignored, and a missing second one is zero.
  Result<void> take_uv(const ObjStatements& statements, std::string_view rest) {
    TextureCoordinate uv;
    if (!parse_real(take_word(rest), uv.u))
      return error(statements, "a texture vertex that begins with no number");
    const std::string_view word = take_word(rest);
    const bool has_v = !word.empty() && word.front() != '#';
    if (has_v && !parse_real(word, uv.v))
      return error(statements, "'" + printable(word) + "' is not a number");
    return uvs_->add([&uv](std::byte* record) { put_attributes({{}, uv}, kKeepUv, record); });
  }

  /// Reads the statement of a face into numbers_, and into uv_vertices_ if they are kept.
  Result<void> read_face(const ObjStatements& statements, std::string_view rest,
                         std::int64_t uvs_before) {
    numbers_.clear();
    uv_vertices_.clear();
    bool has_uvs = true;
    for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) {
      if (word.front() == '#') break;
      std::string_view behind = word;
      std::int64_t number = 0;
      if (!take_integer(behind, number) || !(behind.empty() || behind.front() == '/')) {
        return error(statements, "'" + printable(word) + "' is not a corner of a face");
      }
      numbers_.push_back(number);
      if (!keeps_uvs_) continue;
      uv_vertices_.push_back(uv_vertex(behind, uvs_before));
      has_uvs &= uv_vertices_.back() < uvs_->count();
    }
    if (!has_uvs) without_uvs_.add(statements.position().line);
    return {};
  }

  /// The index of the texture vertex of a corner, which is behind its vertex.
  static std::uint64_t uv_vertex(std::string_view behind, std::int64_t uvs_before) {
    std::int64_t number = 0;
    behind.remove_prefix(std::min<std::size_t>(1, behind.size()));
    if (!take_integer(behind, number) || number == 0) return FaceAttributes::kNone;
    return static_cast<std::uint64_t>(number < 0 ? number + uvs_before : number - 1);
  }

  [[nodiscard]] std::vector<std::string> notes() const {
    std::vector<std::string> notes = notes_.texts();
    if (without_uvs_)
      notes.push_back(counted(without_uvs_.count(), "face") +
                      " with corners that name no texture vertex, the first in line " +
                      std::to_string(without_uvs_.first()) + ", taken with zeros there");
    return notes;
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
  const bool keeps_colors_, keeps_uvs_;
  TextVertices vertices_;
  std::optional<TextRecords> uvs_;
  std::vector<std::int64_t> numbers_;       ///< vertices of the f being read, as written
  std::vector<std::uint64_t> uv_vertices_;  ///< its texture vertices, if they are kept
  ObjNotes notes_;
  RecordNote without_uvs_;  ///< by line
  bool faces_read_ = false;
};

}  // namespace

Result<MeshSummary> read_obj(const MeshFile& file, TriangleSink& sink, MeshScratch& scratch,
                             std::uint32_t keep) {
  if (const auto refused = refuse_attributes("an OBJ", keep & kKeepValue); !refused)
    return refused.error();
  return with_note_of_padding(file, Obj(file, sink, scratch, keep).read());
}

}  // namespace planetree::octree
