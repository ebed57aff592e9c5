#include <cinttypes>
#include <cstdint>
#include <string>
#include <vector>

#include "octree/builder/mesh/stl_reader.h"
#include "octree/builder/mesh/stream/fan_emitter.h"
#include "octree/builder/mesh/stream/mesh_lines.h"
#include "octree/builder/mesh/stream/mesh_note.h"
#include "octree/builder/mesh/stream/mesh_text.h"

namespace planetree::octree {

namespace {

/// The keywords of lines. "end" and the next word are one keyword.
enum class Keyword { kSolid, kFacet, kLoop, kVertex, kEndLoop, kEndFacet, kEndSolid, kOther };

Keyword take_stl_keyword(std::string_view& rest) {
  const std::string_view word = take_word(rest);
  if (is_same_word(word, "vertex")) return Keyword::kVertex;
  if (is_same_word(word, "facet")) return Keyword::kFacet;
  if (is_same_word(word, "outer") || is_same_word(word, "loop")) return Keyword::kLoop;
  if (is_same_word(word, "endloop")) return Keyword::kEndLoop;
  if (is_same_word(word, "endfacet")) return Keyword::kEndFacet;
  if (is_same_word(word, "solid")) return Keyword::kSolid;
  if (is_same_word(word, "endsolid")) return Keyword::kEndSolid;
  if (!is_same_word(word, "end")) return Keyword::kOther;
  std::string_view behind = rest;
  const std::string_view what = take_word(behind);
  if (is_same_word(what, "loop")) return Keyword::kEndLoop;
  if (is_same_word(what, "facet")) return Keyword::kEndFacet;
  return is_same_word(what, "solid") ? Keyword::kEndSolid : Keyword::kOther;
}

/// Reads line by line. The keywords that a line may have depend on the depth:
///   kFile  -> solid -> kSolid -> facet -> kFacet -> outer loop -> kLoop
/// endsolid, endfacet and endloop lead back. A file that ends within a facet was cut off. Lines
/// with other words are passed over, but not within a loop, where they may be misspelled vertices.
class StlAscii {
 public:
  StlAscii(const MeshFile& file, TextPosition begin, TriangleSink& sink)
      : lines_(file, begin), emitter_(sink, RecordKind::kFacet, file.size_bytes()) {}

  Result<MeshSummary> read() {
    while (lines_.next_filled()) {
      if (Result<void> taken = take_line(); !taken) return taken.error();
      if (const auto told = emitter_.advance(lines_.after().offset); !told) return told.error();
    }
    if (lines_.failure()) return *lines_.failure();
    if (depth_ == Depth::kFacet || depth_ == Depth::kLoop)
      return error_at(lines_.after(), "the file ends within a facet: it is truncated");
    if (depth_ == Depth::kSolid && last_is_other_)
      return error_at(lines_.after(), "the file ends in front of 'endsolid': it is truncated");
    emitter_.set_vertex_count(vertex_count_);
    Result<MeshSummary> summary = emitter_.finish(false);
    if (summary) summary->notes = notes();
    return summary;
  }

 private:
  enum class Depth { kFile, kSolid, kFacet, kLoop };

  Result<void> take_line() {
    std::string_view rest = lines_.line();
    const Keyword keyword = take_stl_keyword(rest);
    last_is_other_ = keyword == Keyword::kOther;
    switch (depth_) {
      case Depth::kFile:
        if (keyword == Keyword::kSolid) return enter(Depth::kSolid);
        if (keyword == Keyword::kOther) return pass_over(behind_solids_);
        break;
      case Depth::kSolid:
        if (keyword == Keyword::kFacet) return begin_facet();
        if (keyword == Keyword::kEndSolid) return enter(Depth::kFile);
        if (keyword == Keyword::kSolid) return pass_over(unended_solids_);
        if (keyword == Keyword::kOther) return pass_over(unknown_lines_);
        break;
      case Depth::kFacet:
        if (keyword == Keyword::kLoop) return begin_loop();
        if (keyword == Keyword::kEndFacet) return end_facet();
        if (keyword == Keyword::kOther) return pass_over(unknown_lines_);
        break;
      case Depth::kLoop:
        if (keyword == Keyword::kVertex) return take_vertex(rest);
        if (keyword == Keyword::kEndLoop) return enter(Depth::kFacet);
        break;
    }
    return error("'" + first_word() + "' is not expected here");
  }

  [[nodiscard]] std::string first_word() const {
    std::string_view rest = lines_.line();
    return printable(take_word(rest));
  }

  Result<void> pass_over(MeshNote& note) {
    std::string_view rest = lines_.line();
    note.add(lines_.position().line, take_word(rest));
    return {};
  }

  [[nodiscard]] std::vector<std::string> notes() const {
    std::vector<std::string> notes;
    if (unknown_lines_)
      notes.push_back(unknown_lines_.counted("line") + " of no STL keyword passed over, " +
                      unknown_lines_.first());
    if (unended_solids_)
      notes.push_back(unended_solids_.counted("solid") + " begun before 'endsolid', " +
                      unended_solids_.first());
    if (behind_solids_)
      notes.push_back(behind_solids_.counted("line") + " behind 'endsolid' passed over, " +
                      behind_solids_.first());
    if (depth_ == Depth::kSolid)
      notes.push_back(
          "no 'endsolid' behind the last facet; if facets are missing, copy or export the file "
          "again");
    return notes;
  }

  Result<void> enter(Depth depth) {
    depth_ = depth;
    return {};
  }

  Result<void> begin_facet() {
    corners_.clear();
    has_loop_ = false;
    return enter(Depth::kFacet);
  }

  Result<void> begin_loop() {
    // The corners of two loops are not one polygon.
    if (has_loop_) return error("a facet with a second loop");
    has_loop_ = true;
    return enter(Depth::kLoop);
  }

  Result<void> take_vertex(std::string_view rest) {
    Vec3 position;
    for (double* value : {&position.x, &position.y, &position.z}) {
      const std::string_view word = take_word(rest);
      if (word.empty()) return error("a vertex of fewer than three numbers");
      if (!parse_real(word, *value)) return error("'" + printable(word) + "' is not a number");
    }
    if (!take_word(rest).empty()) return error("a vertex of more than three numbers");
    corners_.push_back(position);
    ++vertex_count_;
    return {};
  }

  Result<void> end_facet() {
    depth_ = Depth::kSolid;
    return emitter_.polygon(facet_count_++, corners_.size(), [this](std::uint64_t k) {
      return MeshCorner{corners_[k], static_cast<std::int64_t>(k), true};
    });
  }

  [[nodiscard]] Error error(const std::string& cause) const {
    return error_at(lines_.position(), cause);
  }

  [[nodiscard]] static Error error_at(const TextPosition& position, const std::string& cause) {
    return make_error(ErrorCode::kBadInput, Error::kNowhere, position.offset,
                      "line %" PRIu64 ": %s; copy or export the STL again", position.line,
                      cause.c_str());
  }

  MeshLines lines_;
  FanEmitter emitter_;
  Depth depth_ = Depth::kFile;
  bool has_loop_ = false;
  bool last_is_other_ = false;  ///< the last line is of no keyword, perhaps a cut one
  std::vector<Vec3> corners_;   ///< corners of the facet being read
  std::uint64_t facet_count_ = 0;
  std::uint64_t vertex_count_ = 0;
  MeshNote unknown_lines_, unended_solids_, behind_solids_;
};

}  // namespace

Result<MeshSummary> read_stl_ascii(const MeshFile& file, TriangleSink& sink) {
  const Result<TextPosition> begin = text_begin(file);
  if (!begin) return begin.error();
  return with_note_of_padding(file, StlAscii(file, *begin, sink).read());
}

}  // namespace planetree::octree
